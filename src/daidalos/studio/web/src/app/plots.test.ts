import type { SerializedDockview } from "dockview-core";
import { expect, test } from "vitest";
import { curveOf } from "../panels/plot/curves";
import { plotSpan, plotTabs } from "./plots";

const leaf = (size: number, ...views: string[]) => ({ type: "leaf", size, data: { views, id: views.join() } });
const branch = (size: number, ...data: unknown[]) => ({ type: "branch", size, data });
const plot = (path: string, title = "Plot", more = {}) => ({
  contentComponent: "plot",
  title,
  params: { curves: [{ path, color: "#111111", over: "" }], ...more },
});

function layout(root: unknown, panels: Record<string, unknown>): SerializedDockview {
  const grid = { root, orientation: "HORIZONTAL", width: 100, height: 100 };
  return { grid, panels } as unknown as SerializedDockview;
}

test("splits keep their direction and shares, other panels are left out", () => {
  const root = branch(100, leaf(40, "scene"), branch(60, leaf(25, "a"), leaf(75, "b", "c")), leaf(20, "d"));
  const panels = {
    scene: { contentComponent: "scene", title: "3D" },
    a: plot("/a", "drive", { origin: "3", span: 30 }),
    b: plot("/b"),
    c: plot("/c", "arm"),
    d: plot("/d"),
  };
  const tabs = plotTabs(layout(root, panels), []);
  expect(tabs.map(([title]) => title)).toEqual(["drive", "arm"]);
  const [main, arm] = tabs.map(([, content]) => content);
  const of = (path: string, origin = "") => ({ curves: [{ ...curveOf(path), color: "#111111" }], origin });
  expect(main).toEqual({
    across: true,
    shares: [0.75, 0.25],
    parts: [{ across: false, shares: [0.25, 0.75], parts: [of("/a", "3"), of("/b")] }, of("/d")],
  });
  expect(arm).toEqual(of("/c"));
  expect(plotSpan(layout(root, panels))).toBe(30);
});

test("a plot that was not changed is saved with what it shows", () => {
  const panels = { a: { contentComponent: "plot", title: "Plot" } };
  const [[, content] = []] = plotTabs(layout(branch(100, leaf(100, "a")), panels), [curveOf("/odom")]);
  expect(content).toMatchObject({ curves: [{ path: "/odom", color: "#5aa9e6" }] });
  expect(plotTabs(layout(branch(100, leaf(100, "scene")), {}), [])).toEqual([]);
});
