import { expect, it } from "vitest";
import { numberAt, splitPath } from "./fields";

it("finds the longest topic that a path begins with", () => {
  const topics = ["/odom", "/odom/pose", "/scan"];
  expect(splitPath("/odom/pose/pose/x", topics)).toEqual({ topic: "/odom/pose", fields: ["pose", "x"] });
  expect(splitPath("/odometry/x", topics)).toBeUndefined();
  expect(splitPath("/scan", topics)).toEqual({ topic: "/scan", fields: [] });
});

it("takes the numbers of elements in brackets, as PlotJuggler and rqt_plot write them", () => {
  const fields = ["points", "0", "positions", "2"];
  for (const path of ["/arm/points[0]/positions[2]", "/arm/points/0/positions/2", "/arm/points[0].positions[2]"]) {
    expect(splitPath(path, ["/arm"])).toEqual({ topic: "/arm", fields });
  }
});

it("reads numbers of any kind, and nothing else", () => {
  const message = { a: { b: [1, 2] }, c: new Float32Array([0.5]), d: 3n, e: true, f: "x" };
  expect(numberAt(message, ["a", "b", "1"])).toBe(2);
  expect(numberAt(message, ["c", "0"])).toBe(0.5);
  expect(numberAt(message, ["d"])).toBe(3);
  expect(numberAt(message, ["e"])).toBe(1);
  expect(numberAt(message, ["f"])).toBeUndefined();
  expect(numberAt(message, ["a"])).toBeUndefined();
  expect(numberAt(message, ["x", "y"])).toBeUndefined();
});
