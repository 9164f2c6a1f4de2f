import { describe, expect, it } from "vitest";
import { extent, formatReading, formatTick, inProportion, roomAround } from "./ranges";

describe("what a plot shows", () => {
  it("has room around the values", () => {
    expect(extent([3, -1, 2])).toEqual([-1, 3]);
    expect(extent([])).toBeUndefined();
    expect(roomAround([0, 10])).toEqual([-0.8, 10.8]);
    expect(roomAround(undefined)).toEqual([-0.08, 1.08]);
  });

  it("does not blow up the rounding of what stands still", () => {
    expect(roomAround([-1e-9, 2e-9])[1]).toBeCloseTo(0.1);
    const [low, high] = roomAround([100, 100.00001]);
    expect(low).toBeCloseTo(90, 3);
    expect(high).toBeCloseTo(110, 3);
  });

  it("keeps the shape of ways", () => {
    const { x, y } = inProportion([0, 2], [0, 4], 2);
    expect(x).toEqual([-3, 5]);
    expect(y).toEqual([0, 4]);
  });

  it("writes numbers so that they differ, and never minus nothing", () => {
    expect([-0.5, -0, 0.5].map((at) => formatTick(at, 0.5))).toEqual(["-0.5", "0.0", "0.5"]);
    expect(formatTick(20, 10)).toBe("20");
    expect(formatTick(1e-9, 1e-9)).toBe("1.00e-9");
    expect([1.2345678, -1.05e-9, 5e-4, 1234567, undefined].map(formatReading)).toEqual([
      "1.2346",
      "0",
      "5.00e-4",
      "1.23e+6",
      "–",
    ]);
  });
});
