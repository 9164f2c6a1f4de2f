// Where boxes and arrows of a diagram are: dagre's layered layout, from left to right.
import type { Arrow, Box, Diagram } from "./diagram";

export interface Placed {
  width: number;
  height: number;
  boxes: (Box & { x: number; y: number; width: number; height: number })[];
  arrows: (Arrow & { path: string })[];
}

const HEIGHT = 30;
const PADDING = 26;
/** As in the style sheet. */
const FONT = "500 12.5px";

/** Place a diagram; the library is loaded with the first one. */
export async function place(diagram: Diagram): Promise<Placed> {
  const dagre = await import("@dagrejs/dagre");
  const graph = new dagre.Graph({ multigraph: true });
  graph.setGraph({ rankdir: "LR", nodesep: 16, ranksep: 56, edgesep: 10, marginx: 24, marginy: 24 });
  graph.setDefaultEdgeLabel(() => ({}));
  for (const { id, name } of diagram.boxes) {
    graph.setNode(id, { width: widthOf(name) + PADDING, height: HEIGHT });
  }
  diagram.arrows.forEach(({ from, to }, i) => graph.setEdge(from, to, {}, String(i)));
  dagre.layout(graph);
  const { width = 0, height = 0 } = graph.graph() as { width?: number; height?: number };
  const boxes = diagram.boxes.map((box) => ({ ...box, ...(graph.node(box.id) as Place) }));
  const arrows = diagram.arrows.map((arrow, i) => {
    const { points } = graph.edge(arrow.from, arrow.to, String(i)) as { points: Point[] };
    const ends = [graph.node(arrow.from) as Place, graph.node(arrow.to) as Place] as const;
    return { ...arrow, path: curve(arrow.from === arrow.to ? points : fromSideToSide(points, ...ends)) };
  });
  return { width, height, boxes, arrows };
}

interface Point {
  x: number;
  y: number;
}

interface Place extends Point {
  width: number;
  height: number;
}

let pen: CanvasRenderingContext2D | undefined;

function widthOf(text: string): number {
  pen ??= document.createElement("canvas").getContext("2d") as CanvasRenderingContext2D;
  pen.font = `${FONT} ${getComputedStyle(document.body).fontFamily}`;
  return pen.measureText(text).width;
}

/** Let a line end in the middle of the sides of its boxes. */
export function fromSideToSide(points: readonly Point[], from: Place, to: Place): Point[] {
  const inner = points.slice(1, -1);
  const after = inner[0] ?? to;
  const before = inner.at(-1) ?? from;
  return [sideTowards(from, after), ...inner, sideTowards(to, before)];
}

function sideTowards({ x, y, width }: Place, other: Point): Point {
  return { x: x + (other.x >= x ? width : -width) / 2, y };
}

/** A line that leaves and arrives level and is round in between. */
export function curve(points: readonly Point[]): string {
  const [first, ...rest] = points;
  if (!first) {
    return "";
  }
  let path = `M${first.x},${first.y}`;
  let last = first;
  for (const next of rest) {
    const middle = (last.x + next.x) / 2;
    path += `C${middle},${last.y} ${middle},${next.y} ${next.x},${next.y}`;
    last = next;
  }
  return path;
}
