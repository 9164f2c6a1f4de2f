// The plots of the page, as the tabs of a layout of PlotJuggler.
import type { SerializedDockview } from "dockview-core";
import type { Plot, Split } from "../generated/arrangement";
import { type Curve, curvesIn, painted } from "../panels/plot/curves";
import { isRecord } from "./stored";

type Tab = readonly [title: string, content: Plot | Split];
type Panels = SerializedDockview["panels"];
interface GridNode {
  type: "branch" | "leaf";
  data: unknown;
  size?: number;
}

/**
 * First what lies side by side, with the first plot of each group of panels, then every plot behind another.
 * `first` is what a plot shows that the user has not changed.
 */
export function plotTabs({ grid, panels }: SerializedDockview, first: readonly Curve[]): readonly Tab[] {
  const behind: Tab[] = [];
  const beside = contentOf(grid.root as GridNode, String(grid.orientation) === "HORIZONTAL", panels, first, behind);
  return beside ? [beside, ...behind] : [];
}

/** The time span of the first plot that has one [s]; 0: none. */
export function plotSpan({ panels }: SerializedDockview): number {
  const spans = plotsAmong(Object.keys(panels), panels).map((id) => Number(panels[id]?.params?.span ?? 0));
  return spans.find((span) => span > 0) ?? 0;
}

function contentOf(
  node: GridNode,
  across: boolean,
  panels: Panels,
  first: readonly Curve[],
  behind: Tab[],
): Tab | undefined {
  if (node.type === "leaf") {
    const views = isRecord(node.data) && Array.isArray(node.data.views) ? (node.data.views as string[]) : [];
    const [shown, ...others] = plotsAmong(views, panels).map((id) => tabOf(id, panels, first));
    behind.push(...others);
    return shown;
  }
  const parts = (node.data as GridNode[]).flatMap((child) => {
    const tab = contentOf(child, !across, panels, first, behind);
    return tab ? [{ tab, size: Math.max(1, child.size ?? 1) }] : [];
  });
  if (parts.length < 2) {
    return parts[0]?.tab;
  }
  const total = parts.reduce((sum, { size }) => sum + size, 0);
  const shares = parts.map(({ size }) => size / total);
  return [(parts[0] as (typeof parts)[0]).tab[0], { across, shares, parts: parts.map(({ tab }) => tab[1]) }];
}

function plotsAmong(ids: readonly string[], panels: Panels): readonly string[] {
  return ids.filter((id) => panels[id]?.contentComponent === "plot");
}

function tabOf(id: string, panels: Panels, first: readonly Curve[]): Tab {
  const { title = "Plot", params = {} } = panels[id] ?? {};
  const curves = painted(curvesIn(params) ?? first);
  return [title, { curves, origin: typeof params.origin === "string" ? params.origin : "" }];
}
