// The drawn plot: uPlot with lines that have points of their own each, and the mouse that zooms.
import uPlot from "uplot";
import { cssColor } from "../../app/theme";
import type { Curve } from "./curves";
import { formatTick, type Range } from "./ranges";

export interface Line {
  xs: readonly number[];
  ys: readonly number[];
}

export interface Box {
  x: Range;
  y: Range;
}

export interface ChartEvents {
  /** Called when the user zooms to a range. */
  onView(box: Box): void;
  /** Called when the user resets the zoom. */
  onReset(): void;
  onHover(at: { x: number; y: number } | undefined): void;
}

const WHEEL_FACTOR = 1.2;
const CLICK_PX = 4;
/** Who drags less than this across one axis means the other one only. */
const ALONG_ONE_PX = 24;
const DIGIT_PX = 6.7;

export class Chart {
  private readonly plot: uPlot;
  private box: Box = { x: [0, 1], y: [0, 1] };

  constructor(
    private readonly element: HTMLElement,
    private readonly curves: readonly Curve[],
    private readonly events: ChartEvents,
    unit: string,
    /** What the mouse did last in the chart that this one takes the place of. */
    public mouse: MouseEvent | undefined,
  ) {
    this.plot = new uPlot(
      this.options(unit),
      [null, ...curves.map(() => [[], []])] as unknown as uPlot.AlignedData,
      element,
    );
    const { over } = this.plot;
    over.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    over.addEventListener("pointerdown", (event) => this.pan(event), { capture: true });
    over.addEventListener("pointerdown", () => this.endWhereReleased());
    over.addEventListener("pointermove", (event) => this.hover(event));
    over.addEventListener("pointerleave", () => this.hover(undefined));
    over.addEventListener("dblclick", () => events.onReset());
  }

  /** Width over height of what is drawn on. */
  get aspect(): number {
    return this.plot.over.clientWidth / Math.max(1, this.plot.over.clientHeight);
  }

  get width(): number {
    return this.plot.over.clientWidth;
  }

  draw(lines: readonly Line[], box: Box): void {
    const isElsewhere = String([this.box.x, this.box.y]) !== String([box.x, box.y]);
    this.box = box;
    const { plot } = this;
    plot.batch(() => {
      plot.setData([null, ...lines.map(({ xs, ys }) => [xs, ys])] as unknown as uPlot.AlignedData, false);
      plot.setScale("x", { min: box.x[0], max: box.x[1] });
      plot.setScale("y", { min: box.y[0], max: box.y[1] });
    });
    if (isElsewhere && this.mouse) {
      this.hover(this.mouse);
    }
  }

  resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width > 0 && height > 0) {
      this.plot.setSize({ width, height });
    }
  }

  dispose(): void {
    this.plot.destroy();
  }

  private options(unit: string): uPlot.Options {
    const axis: uPlot.Axis = {
      stroke: cssColor("text-soft"),
      grid: { stroke: cssColor("line"), width: 1 },
      ticks: { show: false },
      font: "11px system-ui, sans-serif",
      gap: 5,
    };
    const facets = [
      { scale: "x", auto: false },
      { scale: "y", auto: false },
    ];
    return {
      mode: 2,
      width: Math.max(1, this.element.clientWidth),
      height: Math.max(1, this.element.clientHeight),
      legend: { show: false },
      padding: [10, 14, 0, 0],
      cursor: {
        points: { show: false },
        drag: { x: true, y: true, uni: ALONG_ONE_PX, dist: CLICK_PX, setScale: false },
      },
      hooks: { setSelect: [() => this.select()] },
      scales: { x: { time: false, auto: false }, y: { auto: false } },
      axes: [
        {
          ...axis,
          size: 26,
          values: (_plot, splits, _axis, _space, step) => splits.map((at) => formatTick(at, step) + unit),
        },
        {
          ...axis,
          size: (_plot, values) => 14 + DIGIT_PX * Math.max(3, ...(values ?? []).map((value) => value.length)),
          values: (_plot, splits, _axis, _space, step) => splits.map((at) => formatTick(at, step)),
        },
      ],
      series: [
        {},
        ...this.curves.map(({ color, hidden }) => ({
          facets,
          stroke: color,
          width: 1.6,
          show: !hidden,
          paths: drawLine,
        })),
      ],
    };
  }

  /** A box was drawn with the mouse. */
  private select(): void {
    const { plot } = this;
    const { left, top, width, height } = plot.select;
    if (width < CLICK_PX && height < CLICK_PX) {
      return;
    }
    const [x, y] = [this.box.x, this.box.y];
    const isAcross = width >= plot.over.clientWidth - 1;
    const isUpright = height >= plot.over.clientHeight - 1;
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.events.onView({
      x: isAcross ? x : [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")],
      y: isUpright ? y : [plot.posToVal(top + height, "y"), plot.posToVal(top, "y")],
    });
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const factor = event.deltaY + event.deltaX > 0 ? WHEEL_FACTOR : 1 / WHEEL_FACTOR;
    const at = this.at(event);
    const about = ([low, high]: Range, fixed: number): Range => [
      fixed + (low - fixed) * factor,
      fixed + (high - fixed) * factor,
    ];
    const { x, y } = this.box;
    this.events.onView({
      x: event.shiftKey ? x : about(x, at.x),
      y: event.shiftKey || event.ctrlKey ? about(y, at.y) : y,
    });
  }

  /** With the middle button, or with Shift and the left one. */
  private pan(event: PointerEvent): void {
    if (event.button !== 1 && !(event.button === 0 && event.shiftKey)) {
      return;
    }
    event.preventDefault();
    const { over } = this.plot;
    const [from, box] = [{ x: event.clientX, y: event.clientY }, this.box];
    const listening = new AbortController();
    const until = { signal: listening.signal, capture: true };
    over.setPointerCapture(event.pointerId);
    over.addEventListener("mousedown", (pressed) => pressed.stopImmediatePropagation(), { ...until, once: true });
    const drag = ({ clientX, clientY }: PointerEvent) => {
      const x = ((clientX - from.x) / over.clientWidth) * (box.x[1] - box.x[0]);
      const y = ((clientY - from.y) / over.clientHeight) * (box.y[1] - box.y[0]);
      this.events.onView({ x: [box.x[0] - x, box.x[1] - x], y: [box.y[0] + y, box.y[1] + y] });
    };
    over.addEventListener("pointermove", drag, until);
    over.addEventListener("pointerup", () => listening.abort(), until);
    over.addEventListener("pointercancel", () => listening.abort(), until);
  }

  /** uPlot follows the mouse once a frame: on a slow page a box would end where the mouse was a while ago. */
  private endWhereReleased(): void {
    const { plot } = this;
    const end = ({ clientX, clientY }: PointerEvent) => {
      const { left, top, width, height } = plot.over.getBoundingClientRect();
      const within = (at: number, most: number) => Math.min(Math.max(at, 0), most);
      plot.setCursor({ left: within(clientX - left, width), top: within(clientY - top, height) });
    };
    addEventListener("pointerup", end, { capture: true, once: true });
  }

  private hover(event: MouseEvent | undefined): void {
    this.mouse = event;
    this.events.onHover(event && this.at(event));
  }

  private at({ clientX, clientY }: MouseEvent): { x: number; y: number } {
    const { left, top } = this.plot.over.getBoundingClientRect();
    return { x: this.plot.posToVal(clientX - left, "x"), y: this.plot.posToVal(clientY - top, "y") };
  }
}

/** A line through points in their own order, which may go back. */
function drawLine(plot: uPlot, index: number): null {
  const [xs, ys] = (plot.data as unknown as readonly (readonly [number[], number[]])[])[index] ?? [[], []];
  const { ctx, bbox } = plot;
  const { stroke, width = 1 } = plot.series[index] as { stroke: () => string; width?: number };
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.beginPath();
  xs.forEach((x, i) => ctx.lineTo(plot.valToPos(x, "x", true), plot.valToPos(ys[i] as number, "y", true)));
  ctx.strokeStyle = stroke();
  ctx.lineWidth = width * devicePixelRatio;
  ctx.lineJoin = "round";
  ctx.stroke();
  ctx.restore();
  return null;
}
