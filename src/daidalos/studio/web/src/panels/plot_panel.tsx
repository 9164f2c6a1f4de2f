// Plot: fields of messages over time, or over each other.
import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { isRecord } from "../app/stored";
import type { Studio } from "../app/studio";
import { theme } from "../app/theme";
import { numberAt, splitPath } from "../ros/fields";
import { beginsFine } from "../scene/graphics";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { type Box, Chart, type Line } from "./plot/chart";
import { add, type Curve, curvesIn, isXY, painted, turned } from "./plot/curves";
import { PLOT_DRAG } from "./plot/drag";
import { firstCurves } from "./plot/first_curves";
import { History } from "./plot/history";
import { extent, formatReading, inProportion, roomAround } from "./plot/ranges";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/plot.css";

const KEEP = 512;
const WINDOWS = [5, 10, 30, 60, 300] as const;
const KEPT_S = 600;
const DRAW_EVERY_S = beginsFine ? 1 / 30 : 1 / 10;
const MAX_POINTS = 4000;

type Histories = ReadonlyMap<string, History>;

function PlotPanel({ studio, visible, params, remember }: PanelProps) {
  const kept = curvesIn(params);
  const chosen = useSignal<readonly Curve[] | undefined>(kept);
  const first = firstCurves(studio);
  // What everyone has is shown until the user chooses: it is not kept, and not missed where it is not there.
  const curves = painted(chosen.value ?? first);
  const signature = JSON.stringify(curves);
  const span = useSignal(spanOf(params));
  /** The time at which the plot stands still; undefined: it runs. */
  const heldAt = useSignal<number | undefined>(undefined);
  const box = useSignal<Box | undefined>(undefined);
  const cursor = useSignal<{ x: number; y: number } | undefined>(undefined);
  const area = useRef<HTMLDivElement>(null);
  const mouse = useRef<MouseEvent | undefined>(undefined);
  const readings = useSignal<readonly (number | undefined)[]>([]);
  const xy = isXY(curves);
  const change = (changed: readonly Curve[]) => {
    chosen.value = changed;
    remember({ curves: changed, span: span.value });
  };
  const takePath = (path: string) => change(add(chosen.peek() ?? first, path));
  const hold = () => (heldAt.value ??= studio.clock.now(performance.now() / 1000));
  const run = () => ([heldAt.value, box.value] = [undefined, undefined]);
  const histories = useHistories(studio, curves);

  useEffect(() => {
    if (curves.length === 0) {
      return undefined;
    }
    const chart = new Chart(
      area.current as HTMLDivElement,
      curves,
      {
        onView(wanted) {
          hold();
          box.value = wanted;
        },
        onReset: run,
        onHover: (at) => (cursor.value = at),
      },
      xy ? "" : " s",
      mouse.current,
    );
    const observer = new ResizeObserver(() => chart.resize());
    observer.observe(area.current as HTMLDivElement);
    let drawnAt = 0;
    let drawn = "";
    const stopFrames = studio.onFrame((page) => {
      if (page - drawnAt < DRAW_EVERY_S || !visible.peek()) {
        return;
      }
      drawnAt = page;
      const to = heldAt.peek() ?? studio.clock.now(performance.now() / 1000);
      if (to === undefined) {
        return;
      }
      // What stands still is not drawn again.
      const state = JSON.stringify([to, box.peek(), span.peek(), chart.width, chart.aspect]);
      const news = [...histories.current.values()].reduce((sum, { lastTime }) => sum + (lastTime ?? 0), 0);
      if (drawn !== `${state} ${news}`) {
        drawn = `${state} ${news}`;
        draw(chart, curves, histories.current, to, span.peek(), box.peek());
      }
      const at = xy ? undefined : cursor.peek()?.x;
      const values = curves.map(({ path }) => {
        const history = histories.current.get(path);
        return at === undefined ? history?.last : history?.at(to + at);
      });
      if (values.some((value, i) => value !== readings.peek()[i]) || values.length !== readings.peek().length) {
        readings.value = values;
      }
    });
    return () => {
      stopFrames();
      observer.disconnect();
      mouse.current = chart.mouse;
      chart.dispose();
    };
  }, [signature, theme.value]);

  useEffect(() => {
    studio.addToPlot.value ??= takePath;
    return () => {
      if (studio.addToPlot.value === takePath) {
        studio.addToPlot.value = undefined;
      }
    };
  });
  const drop = (event: DragEvent) => {
    const path = event.dataTransfer?.getData(PLOT_DRAG);
    if (path) {
      event.preventDefault();
      takePath(path);
    }
  };
  return (
    <div
      class="column plot"
      onDragOver={allowDrop}
      onDrop={drop}
      onPointerDown={() => (studio.addToPlot.value = takePath)}
    >
      <div class="bar">
        <PathField onAdd={takePath} />
        <span class="plot-axes">
          <Choice
            label="Axes"
            value={xy ? "xy" : "time"}
            options={[
              ["time", "over time"],
              ["xy", "x–y"],
            ]}
            onChange={(kind) => {
              run();
              change(turned(chosen.peek() ?? first, kind === "xy"));
            }}
          />
        </span>
        <Choice
          label="Window"
          value={String(span.value)}
          options={WINDOWS.map((seconds) => [String(seconds), seconds < 60 ? `${seconds} s` : `${seconds / 60} min`])}
          onChange={(seconds) => {
            span.value = Number(seconds);
            remember({ ...(chosen.value ? { curves: chosen.value } : {}), span: span.value });
          }}
        />
        <button
          class={`icon-button ${heldAt.value === undefined ? "" : "active"}`}
          title={heldAt.value === undefined ? "Pause" : "Resume (double click in the plot)"}
          data-test="hold"
          onClick={() => (heldAt.value === undefined ? hold() : run())}
        >
          <Icon name={heldAt.value === undefined ? "pause" : "play"} />
        </button>
        <button
          class="icon-button"
          title="Add a plot below"
          data-test="split"
          onClick={() => studio.openPanel("plot", { curves: [], span: span.value }, "below")}
        >
          <Icon name="split" />
        </button>
      </div>
      {curves.length > 0 && <Legend curves={curves} readings={readings.value} onChange={change} />}
      <div class="plot-area" ref={area}>
        {curves.length > 0 && <CursorReading cursor={cursor} xy={xy} held={heldAt.value !== undefined} />}
      </div>
      {curves.length === 0 && (
        <div class="over">
          <Empty icon="plot" title="Nothing to plot">
            Drag a number here from Topics or Message, or type its path above.
          </Empty>
        </div>
      )}
    </div>
  );
}

interface LegendProps {
  curves: readonly Curve[];
  readings: readonly (number | undefined)[];
  onChange(curves: readonly Curve[]): void;
}

function Legend({ curves, readings, onChange }: LegendProps) {
  const edit = (i: number, changed: Partial<Curve>) =>
    onChange(curves.map((curve, at) => (at === i ? { ...curve, ...changed } : curve)));
  return (
    <div class="legend">
      {curves.map((curve, i) => (
        <span
          key={`${curve.path} ${curve.over}`}
          class={`legend-entry ${curve.hidden ? "off" : ""}`}
          title={curve.path}
        >
          <input
            type="color"
            class="swatch"
            aria-label={`Colour of ${curve.path}`}
            value={curve.color}
            onChange={(event) => edit(i, { color: event.currentTarget.value })}
          />
          <button class="bare legend-name" title="Show or hide" onClick={() => edit(i, { hidden: !curve.hidden })}>
            <span class="ellipsis">{curve.path}</span>
            {curve.over && <span class="faint ellipsis">over {curve.over}</span>}
          </button>
          <span class="figures">{formatReading(readings[i])}</span>
          <button class="bare" title="Remove" onClick={() => onChange(curves.filter((_, at) => at !== i))}>
            <Icon name="close" size={11} />
          </button>
        </span>
      ))}
    </div>
  );
}

interface CursorProps {
  cursor: { value: { x: number; y: number } | undefined };
  xy: boolean;
  held: boolean;
}

/** Where the mouse is, in the plot's own numbers; else how to zoom. */
function CursorReading({ cursor, xy, held }: CursorProps) {
  const text = useComputed(() => {
    const at = cursor.value;
    if (!at) {
      return held ? "Double click: go on" : "";
    }
    return xy ? `x ${formatReading(at.x)}  y ${formatReading(at.y)}` : `${at.x.toFixed(3)} s   ${formatReading(at.y)}`;
  });
  return text.value ? (
    <div class="plot-cursor figures" data-test="cursor">
      {text}
    </div>
  ) : null;
}

function PathField({ onAdd }: { onAdd(path: string): void }) {
  return (
    <input
      class="field grow mono"
      type="text"
      aria-label="Field to plot"
      placeholder="/topic/field/field"
      spellcheck={false}
      onKeyDown={(event) => {
        if (event.key === "Enter") {
          onAdd(event.currentTarget.value.trim());
          event.currentTarget.value = "";
        }
      }}
    />
  );
}

/** The values of every path that the curves need, kept while the panel is there. */
function useHistories(studio: Studio, curves: readonly Curve[]): { current: Histories } {
  const histories = useRef<Map<string, History>>(new Map());
  const paths = [...new Set(curves.flatMap(({ path, over }) => (over ? [path, over] : [path])))];
  const names = topicNames(studio);
  const found = paths.flatMap((path) => {
    const split = splitPath(path, names);
    return split ? [{ path, ...split }] : [];
  });
  useEffect(() => {
    for (const path of histories.current.keys()) {
      if (!paths.includes(path)) {
        histories.current.delete(path);
      }
    }
    const stops = found.map(({ path, topic, fields }) => {
      const history = histories.current.get(path) ?? new History();
      histories.current.set(path, history);
      return studio.session.subscribe(topic, KEEP, (message, time) => {
        const value = numberAt(message, fields);
        if (value !== undefined && time !== history.lastTime) {
          history.push(time, value);
          history.forget(time - KEPT_S);
        }
      });
    });
    return () => stops.forEach((stop) => stop());
  }, [JSON.stringify(found)]);
  return histories;
}

function draw(
  chart: Chart,
  curves: readonly Curve[],
  histories: Histories,
  to: number,
  span: number,
  held: Box | undefined,
): void {
  const xy = isXY(curves);
  const seen = held && !xy ? held.x : ([-span, 0] as const);
  const buckets = Math.max(64, Math.ceil(chart.width / 2));
  const lines = curves.map(({ path, over }): Line => {
    const history = histories.get(path);
    const across = histories.get(over);
    if (xy) {
      return history && across ? history.over(across, to - span, to + 1e-6, MAX_POINTS) : { xs: [], ys: [] };
    }
    const { times, values } = history?.decimate(to + seen[0], to + seen[1], buckets) ?? { times: [], values: [] };
    return { xs: times.map((time) => time - to), ys: values };
  });
  chart.draw(
    lines,
    held ??
      whole(
        chart,
        lines.filter((_, i) => !curves[i]?.hidden),
        xy,
        span,
      ),
  );
}

/** The part that shows all. */
function whole(chart: Chart, lines: readonly Line[], xy: boolean, span: number): Box {
  const y = roomAround(
    extent(lines.flatMap(({ xs, ys }) => (xy ? ys : ys.filter((_, i) => (xs[i] as number) >= -span)))),
  );
  return xy ? inProportion(roomAround(extent(lines.flatMap(({ xs }) => xs))), y, chart.aspect) : { x: [-span, 0], y };
}

function topicNames(studio: Studio): string[] {
  return studio.session.topics.value.map(({ name }) => name);
}

function allowDrop(event: DragEvent): void {
  if (event.dataTransfer?.types.includes(PLOT_DRAG)) {
    event.preventDefault();
  }
}

function spanOf(params: unknown): number {
  return isRecord(params) && typeof params.span === "number" && params.span > 0 ? params.span : 30;
}

export default {
  id: "plot",
  title: "Plot",
  icon: "plot",
  many: true,
  beside: ["topics", 330],
  mount: withPreact(PlotPanel),
} satisfies BuiltInPanel;
