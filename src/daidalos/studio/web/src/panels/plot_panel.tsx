// Plot: fields of messages over time.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { isRecord } from "../app/stored";
import type { Studio } from "../app/studio";
import { theme } from "../app/theme";
import { numberAt, splitPath } from "../ros/fields";
import { beginsFine } from "../scene/graphics";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { Chart, type Curve } from "./plot/chart";
import { PLOT_DRAG } from "./plot/drag";
import { History } from "./plot/history";
import type { PanelProps, PanelType } from "./panel";

const COLORS = ["#5aa9e6", "#f0a35e", "#62c98b", "#e86a92", "#a58be0", "#e3cf5b", "#54c7c1", "#c58f6b"] as const;
const KEEP = 512;
const WINDOWS = [5, 10, 30, 60, 300] as const;
const KEPT_S = 600;
/** What everyone's robot has: a plot that moves is a better first sight than an empty one. */
const FIRST_PATHS = ["/odom/twist/twist/linear/x", "/odom/twist/twist/angular/z"];
const DRAW_EVERY_S = beginsFine ? 1 / 30 : 1 / 10;

function PlotPanel({ studio, visible, params, remember }: PanelProps) {
  const paths = useSignal<readonly string[]>(pathsOf(params));
  const span = useSignal(spanOf(params));
  const paused = useSignal(false);
  const area = useRef<HTMLDivElement>(null);
  const readings = useSignal<readonly (number | undefined)[]>([]);
  const { topics } = studio.session;
  const topicNames = topics.value.map(({ name }) => name).join();

  useEffect(() => remember({ paths: paths.value, span: span.value }), [paths.value, span.value]);

  useEffect(() => {
    const curves = paths.value.map((path, i) => ({
      label: path,
      color: COLORS[i % COLORS.length] as string,
      history: new History(),
    }));
    const stops = listen(studio, curves);
    const chart = new Chart(area.current as HTMLDivElement);
    chart.setCurves(curves);
    const observer = new ResizeObserver(() => chart.resize());
    observer.observe(area.current as HTMLDivElement);
    let drawnAt = 0;
    const stopFrames = studio.onFrame((page) => {
      if (page - drawnAt > DRAW_EVERY_S && visible.peek() && !paused.peek()) {
        drawnAt = page;
        draw(studio, chart, curves, span.peek());
        readings.value = curves.map(({ history }) => history.last);
      }
    });
    return () => {
      stopFrames();
      observer.disconnect();
      chart.dispose();
      for (const stop of stops) {
        stop();
      }
    };
  }, [paths.value, topicNames, theme.value]);

  const add = (path: string) => {
    if (path && !paths.value.includes(path)) {
      paths.value = [...paths.value, path];
    }
  };
  const drop = (event: DragEvent) => {
    const path = event.dataTransfer?.getData(PLOT_DRAG);
    if (path) {
      event.preventDefault();
      add(path);
    }
  };
  return (
    <div class="column plot" onDragOver={allowDrop} onDrop={drop}>
      <div class="bar">
        <PathField onAdd={add} />
        <Choice
          label="Window"
          value={String(span.value)}
          options={WINDOWS.map((seconds) => [String(seconds), seconds < 60 ? `${seconds} s` : `${seconds / 60} min`])}
          onChange={(seconds) => (span.value = Number(seconds))}
        />
        <button
          class={`icon-button ${paused.value ? "active" : ""}`}
          title={paused.value ? "Go on" : "Hold"}
          onClick={() => (paused.value = !paused.value)}
        >
          <Icon name={paused.value ? "play" : "pause"} />
        </button>
      </div>
      <div class="legend">
        {paths.value.map((path, i) => (
          <span key={path} class="legend-entry" title={path}>
            <span class="swatch" style={{ background: COLORS[i % COLORS.length] }} />
            <span class="ellipsis">{path}</span>
            <span class="figures">{reading(readings.value[i])}</span>
            <button
              class="bare"
              title="Remove"
              onClick={() => (paths.value = paths.value.filter((each) => each !== path))}
            >
              <Icon name="close" size={11} />
            </button>
          </span>
        ))}
      </div>
      <div class="plot-area" ref={area} />
      {paths.value.length === 0 && (
        <div class="over">
          <Empty icon="plot" title="Nothing to plot">
            Drag a number here from Message, or type its path above.
          </Empty>
        </div>
      )}
    </div>
  );
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

function listen(studio: Studio, curves: readonly Curve[]): (() => void)[] {
  const topics = studio.session.topics.value.map(({ name }) => name);
  return curves.flatMap(({ label, history }) => {
    const found = splitPath(label, topics);
    if (!found) {
      return [];
    }
    return studio.session.subscribe(found.topic, KEEP, (message, time) => {
      const value = numberAt(message, found.fields);
      if (value !== undefined) {
        history.push(time, value);
        history.forget(time - KEPT_S);
      }
    });
  });
}

function draw(studio: Studio, chart: Chart, curves: readonly Curve[], span: number): void {
  const newest = Math.max(...curves.map(({ history }) => history.lastTime ?? -Infinity));
  const to = studio.clock.now(performance.now() / 1000) ?? newest;
  if (Number.isFinite(to)) {
    chart.draw(to - span, to);
  }
}

function allowDrop(event: DragEvent): void {
  if (event.dataTransfer?.types.includes(PLOT_DRAG)) {
    event.preventDefault();
  }
}

function reading(value: number | undefined): string {
  return value === undefined ? "" : value.toPrecision(4);
}

function pathsOf(params: unknown): readonly string[] {
  return isRecord(params) && Array.isArray(params.paths)
    ? params.paths.filter((path) => typeof path === "string")
    : FIRST_PATHS;
}

function spanOf(params: unknown): number {
  return isRecord(params) && typeof params.span === "number" && params.span > 0 ? params.span : 30;
}

export const PLOT_PANEL: PanelType = { id: "plot", title: "Plot", icon: "plot", many: true, component: PlotPanel };
