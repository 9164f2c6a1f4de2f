// Graph: nodes and topics, and their connections, as rqt_graph shows them.
import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import type { ConnectionGraph } from "../connection/boundary";
import type { Studio } from "../app/studio";
import { Choice } from "../ui/editors";
import { Empty } from "../ui/empty";
import { Icon } from "../ui/icons";
import { SearchField } from "../ui/search";
import { Canvas } from "./graph/canvas";
import { around, diagramOf, nodeId, type Kind, type DiagramOptions } from "./graph/diagram";
import { place, type Placed } from "./graph/layout";
import { type BuiltInPanel, type PanelProps, withPreact } from "./panel";
import "../styles/graph.css";

const KINDS: readonly (readonly [Kind, string])[] = [
  ["nodes", "Nodes only"],
  ["active", "Nodes and topics"],
  ["all", "Nodes and all topics"],
];
const SWITCHES = [
  ["debug", "Debug", "Show /rosout, /parameter_events and tools such as this one"],
  ["tf", "tf", "Show transforms and the clock"],
  ["hidden", "Hidden", "Show names that begin with an underscore"],
] as const;
const FIRST: DiagramOptions = { kind: "active", filter: "", debug: false, tf: false, hidden: false };

function GraphPanel({ studio, visible, params, remember }: PanelProps) {
  const { session } = studio;
  const options = useSignal<DiagramOptions>(optionsOf(params));
  const placed = useSignal<Placed | undefined>(undefined);
  const hovered = useSignal("");
  const picked = useSignal("");
  const isVisible = visible.value;
  useEffect(() => (isVisible ? session.watchGraph() : undefined), [isVisible]);
  const graph = session.graph.value;
  const diagram = graph && diagramOf(graph, options.value);
  const told = JSON.stringify(diagram);
  useEffect(() => {
    let isNewest = true;
    if (diagram) {
      void place(diagram).then((result) => {
        if (isNewest) {
          placed.value = result;
        }
      });
    }
    return () => {
      isNewest = false;
    };
  }, [told]);
  const change = (change: Partial<DiagramOptions>) => {
    options.value = { ...options.value, ...change };
    const { filter, ...kept } = options.value;
    remember(kept);
  };
  return (
    <div class="column graph">
      <div class="bar wrap">
        <Choice
          label="What is shown"
          value={options.value.kind}
          options={KINDS}
          onChange={(kind) => change({ kind: kind as Kind })}
        />
        <SearchField
          value={options.value.filter}
          placeholder="Filter by name"
          onChange={(filter) => change({ filter })}
        />
        {SWITCHES.map(([name, label, title]) => (
          <button
            key={name}
            class={`chip ${options.value[name] ? "on" : ""}`}
            title={title}
            aria-pressed={options.value[name]}
            data-test={`graph-${name}`}
            onClick={() => change({ [name]: !options.value[name] })}
          >
            {label}
          </button>
        ))}
      </div>
      {placed.value?.boxes.length ? (
        <Drawing placed={placed.value} hovered={hovered} picked={picked} />
      ) : (
        <Empty icon="graph" title={options.value.filter ? "No match" : "No nodes yet"}>
          {options.value.filter ? "" : "They appear as soon as they start."}
        </Empty>
      )}
      {graph && <Details studio={studio} graph={graph} id={hovered.value || picked.value} />}
    </div>
  );
}

interface DrawingProps {
  placed: Placed;
  hovered: Signal<string>;
  picked: Signal<string>;
}

function Drawing({ placed, hovered, picked }: DrawingProps) {
  const frame = useRef<SVGSVGElement>(null);
  const content = useRef<SVGGElement>(null);
  const canvas = useRef<Canvas>(undefined);
  const size = useRef(placed);
  size.current = placed;
  const fit = () => canvas.current?.fit(size.current.width, size.current.height);
  useLayoutEffect(() => {
    const made = new Canvas(frame.current as SVGSVGElement, content.current as SVGGElement);
    canvas.current = made;
    const observer = new ResizeObserver(() => made.isMoved || fit());
    observer.observe(frame.current as SVGSVGElement);
    return () => {
      observer.disconnect();
      made.dispose();
    };
  }, []);
  useLayoutEffect(() => {
    if (!canvas.current?.isMoved) {
      fit();
    }
  }, [placed]);
  const centre = hovered.value || picked.value;
  const near = placed.boxes.some(({ id }) => id === centre) ? around(placed, centre) : undefined;
  const light = (isNear: boolean | undefined) => (near ? (isNear ? "near" : "far") : "");
  return (
    <div class="graph-frame">
      <svg
        ref={frame}
        data-test="graph"
        onClick={() => {
          if (canvas.current?.wasClick) {
            picked.value = "";
          }
        }}
        onDblClick={fit}
      >
        <defs>
          {["", "near"].map((kind) => (
            <marker
              key={kind}
              id={`graph-head${kind}`}
              class={`graph-head ${kind}`}
              viewBox="0 0 8 8"
              refX="7.4"
              refY="4"
              markerWidth="8"
              markerHeight="8"
              markerUnits="userSpaceOnUse"
              orient="auto"
            >
              <path d="M0 .8L8 4 0 7.2z" />
            </marker>
          ))}
        </defs>
        <g ref={content}>
          {placed.arrows.map(({ from, to, topics, path }, i) => {
            const isNear = near?.arrows.has(i);
            return (
              <path
                key={`${from} ${to}`}
                class={`graph-arrow ${light(isNear)}`}
                d={path}
                data-arrow={`${from.slice(1)} ${to.slice(1)}`}
                marker-end={`url(#graph-head${isNear ? "near" : ""})`}
              >
                <title>{topics.join("\n")}</title>
              </path>
            );
          })}
          {placed.boxes.map(({ id, is, name, x, y, width, height }) => (
            <g
              key={id}
              class={`graph-box ${is} ${light(near?.boxes.has(id))} ${id === centre ? "centre" : ""}`}
              data-box={name}
              data-is={is}
              onPointerEnter={() => (hovered.value = id)}
              onPointerLeave={() => (hovered.value = "")}
              onClick={(event) => {
                event.stopPropagation();
                if (canvas.current?.wasClick) {
                  picked.value = picked.value === id ? "" : id;
                }
              }}
            >
              <rect x={x - width / 2} y={y - height / 2} rx={is === "node" ? height / 2 : 4} {...{ width, height }} />
              <text {...{ x, y }}>{name}</text>
            </g>
          ))}
        </g>
      </svg>
      <div class="overlay-bar views" role="toolbar" aria-label="View">
        <button class="tool" title="Zoom in" onClick={() => canvas.current?.zoom(1.25)}>
          <Icon name="add" />
        </button>
        <button class="tool" title="Zoom out" onClick={() => canvas.current?.zoom(0.8)}>
          <Icon name="minus" />
        </button>
        <button class="tool" title="Show everything (double click)" data-test="graph-fit" onClick={fit}>
          <Icon name="focus" />
        </button>
      </div>
    </div>
  );
}

/** What there is to know of a box: of a topic its type, of a node all that it offers. */
function Details({ studio, graph, id }: { studio: Studio; graph: ConnectionGraph; id: string }) {
  const name = id.slice(1);
  if (!id) {
    return <footer class="bar faint">Hover over a box to highlight its neighbours · click to pin them</footer>;
  }
  if (id !== nodeId(name)) {
    const look = () => {
      studio.selectedTopic.value = name;
      studio.openPanel("message");
    };
    return (
      <footer class="bar faint" data-test="graph-details">
        <b>{name}</b>
        <span class="mono ellipsis">{studio.session.typeOf(name) ?? ""}</span>
        <span class="stretch" />
        <span>
          {count(graph.publishers.get(name)?.length ?? 0, "publisher")},{" "}
          {count(graph.subscribers.get(name)?.length ?? 0, "subscriber")}
        </span>
        <button class="button small" onClick={look}>
          Messages
        </button>
      </footer>
    );
  }
  const of = (side: ReadonlyMap<string, readonly string[]>) => {
    const found = [...side].filter(([, nodes]) => nodes.includes(name)).map(([each]) => each);
    return { title: found.sort().join("\n"), number: found.length };
  };
  const [publishes, subscribes, provides] = [of(graph.publishers), of(graph.subscribers), of(graph.services)];
  return (
    <footer class="bar faint" data-test="graph-details">
      <b>{name}</b>
      <span class="stretch" />
      <span title={publishes.title}>publishes {count(publishes.number, "topic")}</span>
      <span title={subscribes.title}>· subscribes to {count(subscribes.number, "topic")}</span>
      <span title={provides.title}>· offers {count(provides.number, "service")}</span>
    </footer>
  );
}

function count(number: number, what: string): string {
  return `${number} ${what}${number === 1 ? "" : "s"}`;
}

function optionsOf(params: Readonly<Record<string, unknown>>): DiagramOptions {
  const kind = KINDS.find(([each]) => each === params.kind)?.[0] ?? FIRST.kind;
  const given = (name: "debug" | "tf" | "hidden") => params[name] === true;
  return { ...FIRST, kind, debug: given("debug"), tf: given("tf"), hidden: given("hidden") };
}

export default {
  id: "graph",
  title: "Graph",
  icon: "graph",
  mount: withPreact(GraphPanel),
} satisfies BuiltInPanel;
