import { describe, expect, it } from "vitest";
import { add, curveOf, curvesIn, isXY, painted, turned } from "./curves";

describe("the curves of a plot", () => {
  it("are there once, and each has a colour", () => {
    const curves = add(add(add([], "/a/x"), "/a/y"), "/a/x");
    expect(curves.map(({ path }) => path)).toEqual(["/a/x", "/a/y"]);
    const colors = painted(curves).map(({ color }) => color);
    expect(new Set(colors).size).toBe(2);
    expect(painted([{ ...curveOf("/a/x"), color: "#123456" }])[0]?.color).toBe("#123456");
  });

  it("are drawn over the first of them, and over time again", () => {
    const curves = [curveOf("/a/x"), curveOf("/a/y"), curveOf("/a/z")];
    const over = turned(curves, true);
    expect(over.map((curve) => [curve.path, curve.over])).toEqual([
      ["/a/y", "/a/x"],
      ["/a/z", "/a/x"],
    ]);
    expect(isXY(over)).toBe(true);
    expect(add(over, "/a/x")).toBe(over);
    expect(add(over, "/b").at(-1)?.over).toBe("/a/x");
    expect(turned(over, false).map(({ path }) => path)).toEqual(["/a/x", "/a/y", "/a/z"]);
    expect(turned([curveOf("/a/x")], true)).toEqual([curveOf("/a/x")]);
  });

  it("are read from whatever was remembered", () => {
    expect(curvesIn({})).toBeUndefined();
    expect(curvesIn({ curves: [{ path: "/a" }, 3, { color: "red" }] })).toEqual([curveOf("/a")]);
  });
});
