import { Color } from "three";
import { describe, expect, it } from "vitest";
import { gradientOf, rowOf, type Outlook } from "./backdrop";
import { DAYLIGHT, DUSK } from "./looks";

const LEVEL: Outlook = { pitch: 0, half: 0.4, height: 1.5, reach: 5 };

/** Colours and rows of a gradient. */
const stopsOf = (gradient: string) =>
  [...gradient.matchAll(/(#[0-9a-f]{6}) ([\d.]+)%/g)].map(([, color, row]) => ({
    color: new Color(color),
    row: Number(row) / 100,
  }));

describe("sky and ground", () => {
  it("meet in the middle of who looks straight ahead, and above who looks down", () => {
    expect(rowOf(0, LEVEL)).toBeCloseTo(0.5);
    expect(rowOf(0, { ...LEVEL, pitch: 0.4 })).toBeCloseTo(0);
    expect(rowOf(0, { ...LEVEL, pitch: 0.8 })).toBeLessThan(0);
  });

  it.each([["daylight", DAYLIGHT] as const, ["dusk", DUSK] as const])("differ, without a step, in %s", (_, look) => {
    const stops = stopsOf(gradientOf(look, LEVEL));
    expect(stops[0]?.color.getHexString()).not.toBe(stops.at(-1)?.color.getHexString());
    const horizon = stops.find(({ row }) => Math.abs(row - 0.5) < 0.001);
    expect(`#${horizon?.color.getHexString()}`).toBe(look.horizon);
    expect(stops.map(({ row }) => row)).toEqual(stops.map(({ row }) => row).sort((a, b) => a - b));
  });

  it("is the ground alone from straight above", () => {
    expect(gradientOf(DUSK, undefined)).toBe(DUSK.ground);
  });
});
