// Which part of the values a plot shows, and how its numbers are written.

export type Range = readonly [low: number, high: number];

const MARGIN = 0.08;
/** What differs less than this is the rounding of what stands still. */
const NOISE = 1e-5;

/** The least and the greatest value; undefined where there is none. */
export function extent(values: Iterable<number>): Range | undefined {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  return low <= high ? [low, high] : undefined;
}

/** A range with room around it, also around what stands still. */
export function roomAround(range: Range | undefined): Range {
  const [low, high] = range ?? [0, 1];
  const still = Math.max(Math.abs(low), Math.abs(high));
  const margin = high - low > NOISE * Math.max(1, still) ? MARGIN * (high - low) : Math.max(0.1, 0.1 * still);
  return [low - margin, high + margin];
}

/** Ranges in which a metre is as long across as it is upright: ways keep their shape. */
export function inProportion(x: Range, y: Range, aspect: number): { x: Range; y: Range } {
  const [width, height] = [x[1] - x[0], y[1] - y[0]];
  const wide = Math.max(width, height * aspect);
  return { x: widened(x, wide), y: widened(y, wide / aspect) };
}

function widened([low, high]: Range, size: number): Range {
  const middle = (low + high) / 2;
  return [middle - size / 2, middle + size / 2];
}

/** A number at an axis, with as many decimals as its neighbours need to differ. */
export function formatTick(value: number, step: number): string {
  const decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  if (decimals > 6 || Math.abs(value) >= 1e7) {
    return value.toExponential(2);
  }
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text;
}

/** A reading beside a curve's name. */
export function formatReading(value: number | undefined): string {
  if (value === undefined) {
    return "–";
  }
  const size = Math.abs(value);
  if (size < NOISE) {
    return "0";
  }
  return size >= 1e6 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(5)));
}
