// The diagram of the ROS graph: boxes for nodes and topics, arrows for publishers and subscriptions.
import type { ConnectionGraph } from "../../connection/boundary";

/** As rqt_graph has it: nodes alone, topics that connect nodes, all topics. */
export type Kind = "nodes" | "active" | "all";

export interface DiagramOptions {
  kind: Kind;
  /** Part of the names of what is shown, with its neighbours; empty: everything. */
  filter: string;
  /** Whether to show what serves looking and logging: /rosout, /parameter_events, tools. */
  debug: boolean;
  /** Whether to show transforms and the clock, to which almost everyone listens. */
  tf: boolean;
  /** Whether to show names that begin with an underscore. */
  hidden: boolean;
}

export interface Box {
  id: string;
  name: string;
  is: "node" | "topic";
}

export interface Arrow {
  from: string;
  to: string;
  /** The topics that an arrow from node to node stands for. */
  topics: string[];
}

export interface Diagram {
  boxes: Box[];
  arrows: Arrow[];
}

const DEBUG_TOPICS = new Set(["/rosout", "/parameter_events", "/statistics", "/diagnostics"]);
const DEBUG_NODE = /^\/(rqt_gui_py_node_\d+|rqt\w*|rviz2?|plotjuggler|foxglove_bridge|studio|.*_studio)$/;
const SHARED_TOPICS = new Set(["/tf", "/tf_static", "/clock"]);

export function diagramOf(graph: ConnectionGraph, options: DiagramOptions): Diagram {
  const isWanted = (name: string) =>
    (options.hidden || !name.includes("/_")) && (options.debug || !DEBUG_NODE.test(name));
  const isTopicWanted = (name: string) =>
    (options.hidden || !name.includes("/_")) &&
    (options.debug || !DEBUG_TOPICS.has(name)) &&
    (options.tf || !SHARED_TOPICS.has(name));
  const nodes = [...nodesOf(graph)].filter(isWanted);
  const topics = [...new Set([...graph.publishers.keys(), ...graph.subscribers.keys()])].filter(isTopicWanted).sort();
  const draft = options.kind === "nodes" ? nodeDiagram(graph, topics, isWanted) : { boxes: [], arrows: [] };
  if (options.kind !== "nodes") {
    addTopics(draft, graph, topics, isWanted, options.kind === "active");
  }
  draft.boxes.unshift(...nodes.sort().map((name): Box => ({ id: nodeId(name), name, is: "node" })));
  return narrow(draft, options.filter);
}

/** What a box is connected with, itself included; the arrows are those by their place in the diagram. */
export function around(diagram: Diagram, id: string): { boxes: Set<string>; arrows: Set<number> } {
  const [boxes, arrows] = [new Set([id]), new Set<number>()];
  diagram.arrows.forEach(({ from, to }, i) => {
    if (from === id || to === id) {
      boxes.add(from).add(to);
      arrows.add(i);
    }
  });
  return { boxes, arrows };
}

export function nodeId(name: string): string {
  return `n${name}`;
}

function nodesOf({ publishers, subscribers, services }: ConnectionGraph): Set<string> {
  return new Set([publishers, subscribers, services].flatMap((side) => [...side.values()].flat()));
}

function nodeDiagram(graph: ConnectionGraph, topics: string[], isWanted: (node: string) => boolean): Diagram {
  const arrows = new Map<string, Arrow>();
  for (const topic of topics) {
    for (const from of (graph.publishers.get(topic) ?? []).filter(isWanted)) {
      for (const to of (graph.subscribers.get(topic) ?? []).filter(isWanted)) {
        const key = `${from} ${to}`;
        const arrow = arrows.get(key) ?? { from: nodeId(from), to: nodeId(to), topics: [] };
        arrow.topics.push(topic);
        arrows.set(key, arrow);
      }
    }
  }
  return { boxes: [], arrows: [...arrows.values()] };
}

function addTopics(
  diagram: Diagram,
  graph: ConnectionGraph,
  topics: string[],
  isWanted: (node: string) => boolean,
  onlyActive: boolean,
): void {
  for (const name of topics) {
    const publishers = (graph.publishers.get(name) ?? []).filter(isWanted);
    const subscribers = (graph.subscribers.get(name) ?? []).filter(isWanted);
    if (onlyActive ? !(publishers.length && subscribers.length) : !(publishers.length || subscribers.length)) {
      continue;
    }
    const id = `t${name}`;
    diagram.boxes.push({ id, name, is: "topic" });
    diagram.arrows.push(
      ...publishers.map((node) => ({ from: nodeId(node), to: id, topics: [name] })),
      ...subscribers.map((node) => ({ from: id, to: nodeId(node), topics: [name] })),
    );
  }
}

function narrow(diagram: Diagram, filter: string): Diagram {
  const wanted = filter.trim().toLowerCase();
  if (!wanted) {
    return diagram;
  }
  const kept = new Set<string>();
  for (const { id, name } of diagram.boxes) {
    if (name.toLowerCase().includes(wanted)) {
      for (const each of around(diagram, id).boxes) {
        kept.add(each);
      }
    }
  }
  return {
    boxes: diagram.boxes.filter(({ id }) => kept.has(id)),
    arrows: diagram.arrows.filter(({ from, to }) => kept.has(from) && kept.has(to)),
  };
}
