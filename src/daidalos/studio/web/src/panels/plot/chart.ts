// The drawn plot: uPlot with a window of time that moves along.
import uPlot from "uplot";
import { cssColor } from "../../app/theme";
import type { History } from "./history";

export interface Curve {
  label: string;
  color: string;
  history: History;
}

export class Chart {
  private plot: uPlot | undefined;
  private curves: readonly Curve[] = [];
  private origin = 0;

  constructor(private readonly element: HTMLElement) {}

  setCurves(curves: readonly Curve[]): void {
    this.curves = curves;
    this.build();
  }

  /** Draw the curves between two times; the axis counts seconds back from the end. */
  draw(from: number, to: number): void {
    const { plot } = this;
    if (!plot || this.curves.length === 0) {
      return;
    }
    this.origin = to;
    const buckets = Math.max(64, Math.ceil(plot.width / 2));
    const tables = this.curves.map(({ history }) => {
      const { times, values } = history.decimate(from, to, buckets);
      return [times.map((time) => time - to), values] as uPlot.AlignedData;
    });
    plot.setData(tables.length === 1 ? (tables[0] as uPlot.AlignedData) : uPlot.join(tables), false);
    plot.setScale("x", { min: from - to, max: 0 });
  }

  /** The time under the cursor; undefined when it is elsewhere. */
  get cursorTime(): number | undefined {
    const index = this.plot?.cursor.idx;
    const x = index === null || index === undefined ? undefined : this.plot?.data[0][index];
    return x === undefined ? undefined : x + this.origin;
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (this.plot && width > 0 && height > 0) {
      this.plot.setSize({ width, height });
    }
  }

  dispose(): void {
    this.plot?.destroy();
  }

  private build(): void {
    this.plot?.destroy();
    this.plot = undefined;
    if (this.curves.length === 0) {
      return;
    }
    const axis: uPlot.Axis = {
      stroke: cssColor("text-faint"),
      grid: { stroke: cssColor("line"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
      size: 26,
      gap: 4,
    };
    this.plot = new uPlot(
      {
        width: Math.max(1, this.element.clientWidth),
        height: Math.max(1, this.element.clientHeight),
        legend: { show: false },
        padding: [10, 12, 0, 0],
        cursor: { drag: { x: false, y: false }, points: { size: 6 } },
        scales: { x: { time: false }, y: { range: yRange } },
        axes: [
          { ...axis, values: (_, splits) => splits.map((split) => `${split}s`) },
          { ...axis, size: 48 },
        ],
        series: [
          {},
          ...this.curves.map(({ label, color }) => ({
            label,
            stroke: color,
            width: 1.6,
            spanGaps: true,
            points: { show: false },
          })),
        ],
      },
      [[]],
      this.element,
    );
  }
}

/** Room above and below, also for a curve that is flat. */
function yRange(_plot: uPlot, least: number | null, most: number | null): [number, number] {
  const [low, high] = [least ?? 0, most ?? 1];
  const margin = high > low ? 0.08 * (high - low) : Math.max(0.1, Math.abs(high) * 0.1);
  return [low - margin, high + margin];
}
