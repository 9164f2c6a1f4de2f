import { expect, it } from "vitest";
import type { Arrangement } from "../generated/arrangement";
import { displaysOf, firstPlot } from "./arrangement";

const NOTHING: Arrangement = {
  fixedFrame: "",
  followed: "",
  tabs: [],
  span: 0,
  panels: [],
  leftOut: [],
  source: "",
};

it("asks for displays, with what it leaves open as always", () => {
  const path = { origin: "0", type: "Path", name: "Way", enabled: false, settings: { topic: "/way", alpha: 0.5 } };
  const displays = displaysOf({ ...NOTHING, displays: [path, { ...path, type: "their_plugins/Unheard" }] });
  expect(displays).toHaveLength(2);
  expect(displays?.[1]).toMatchObject({ type: "their_plugins/Unheard", origin: "0" });
  expect(displays?.[0]).toMatchObject({ type: "Path", name: "Way", enabled: false });
  expect(displays?.[0]?.settings).toMatchObject({ topic: "/way", alpha: 0.5, width: 3.5 });
  expect(displaysOf(NOTHING)).toBeUndefined();
});

it("has a first plot, however it is split", () => {
  const plot = { curves: [{ path: "/a", color: "", over: "" }], origin: "0" };
  const split = { across: true, shares: [1, 1], parts: [plot, { curves: [], origin: "" }] };
  expect(firstPlot({ across: false, shares: [1], parts: [split] })).toBe(plot);
  expect(firstPlot({ across: false, shares: [], parts: [] })).toEqual({ curves: [], origin: "" });
});
