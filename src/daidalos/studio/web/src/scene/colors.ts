// Colour maps: for occupancy grids as RViz paints them, and for values along a scale.

/** Colours as bytes r, g, b, a, one after another. */
export type Palette = Uint8Array<ArrayBuffer>;

const UNKNOWN = 255; // -1 as an unsigned byte
const RVIZ_UNKNOWN = [0x70, 0x89, 0x86, 255] as const;

/** RViz's "map": free is white, occupied is black, unknown is grey-green. */
export function mapPalette(): Palette {
  const palette = illegalValues();
  for (let value = 0; value <= 100; value++) {
    const grey = 255 - Math.floor((255 * value) / 100);
    set(palette, value, [grey, grey, grey, 255]);
  }
  set(palette, UNKNOWN, RVIZ_UNKNOWN);
  return palette;
}

/** RViz's "costmap": free is clear, costs go from blue to red, then cyan (inscribed) and purple (lethal). */
export function costmapPalette(): Palette {
  const palette = illegalValues();
  set(palette, 0, [0, 0, 0, 0]);
  for (let value = 1; value <= 98; value++) {
    const red = Math.floor((255 * value) / 100);
    set(palette, value, [red, 0, 255 - red, 255]);
  }
  set(palette, 99, [0, 255, 255, 255]);
  set(palette, 100, [255, 0, 255, 255]);
  set(palette, UNKNOWN, RVIZ_UNKNOWN);
  return palette;
}

/** RViz's "raw": every byte as its grey. */
export function rawPalette(): Palette {
  const palette = new Uint8Array(1024);
  for (let value = 0; value < 256; value++) {
    set(palette, value, [value, value, value, 255]);
  }
  return palette;
}

/** Values that no occupancy grid should hold: green above 100, red to yellow for negative ones. */
function illegalValues(): Palette {
  const palette = new Uint8Array(1024);
  for (let value = 101; value <= 127; value++) {
    set(palette, value, [0, 255, 0, 255]);
  }
  for (let value = 128; value <= 254; value++) {
    set(palette, value, [255, Math.floor((255 * (value - 128)) / (254 - 128)), 0, 255]);
  }
  return palette;
}

function set(palette: Palette, value: number, color: readonly number[]): void {
  palette.set(color, value * 4);
}

/**
 * Google's Turbo: an even rainbow, for values that must be read off.
 *
 * Polynomial by Mikhailov, "Turbo, an improved rainbow colormap for visualization" (2019).
 */
export function turbo(share: number): [r: number, g: number, b: number] {
  const x = Math.min(1, Math.max(0, share));
  const poly = (c: readonly number[]) => c.reduceRight((sum, each) => sum * x + each, 0);
  return [
    byte(poly([0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943])),
    byte(poly([0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604])),
    byte(poly([0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973])),
  ];
}

/** Turbo as 256 colours r, g, b. */
export const TURBO = Uint8Array.from({ length: 256 }, (_, i) => i).reduce((table, i) => {
  table.set(turbo(i / 255), i * 3);
  return table;
}, new Uint8Array(768));

export function parseColor(hex: string): [r: number, g: number, b: number] {
  const value = Number.parseInt(hex.replace("#", ""), 16);
  return Number.isNaN(value) ? [255, 255, 255] : [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

function byte(share: number): number {
  return Math.min(255, Math.max(0, Math.round(255 * share)));
}
