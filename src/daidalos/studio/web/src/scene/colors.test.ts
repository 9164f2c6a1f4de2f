import { expect, it } from "vitest";
import { costmapPalette, mapPalette, parseColor, rawPalette, TURBO, type Palette } from "./colors";

const at = (palette: Palette, value: number) => [...palette.slice(4 * (value & 255), 4 * (value & 255) + 4)];

it("paints maps as RViz does", () => {
  const palette = mapPalette();
  expect(at(palette, 0)).toEqual([255, 255, 255, 255]);
  expect(at(palette, 50)).toEqual([128, 128, 128, 255]);
  expect(at(palette, 100)).toEqual([0, 0, 0, 255]);
  expect(at(palette, -1)).toEqual([0x70, 0x89, 0x86, 255]);
  expect(at(palette, 101)).toEqual([0, 255, 0, 255]);
  expect(at(palette, -128)).toEqual([255, 0, 0, 255]);
  expect(at(palette, -2)).toEqual([255, 255, 0, 255]);
});

it("paints costmaps as RViz does", () => {
  const palette = costmapPalette();
  expect(at(palette, 0)).toEqual([0, 0, 0, 0]);
  expect(at(palette, 1)).toEqual([2, 0, 253, 255]);
  expect(at(palette, 98)).toEqual([249, 0, 6, 255]);
  expect(at(palette, 99)).toEqual([0, 255, 255, 255]);
  expect(at(palette, 100)).toEqual([255, 0, 255, 255]);
  expect(at(palette, -1)).toEqual([0x70, 0x89, 0x86, 255]);
});

it("paints raw values as greys", () => {
  expect(at(rawPalette(), 200)).toEqual([200, 200, 200, 255]);
});

it("runs Turbo from dark blue over green to dark red", () => {
  const [low, middle, high] = [26, 128, 255].map((i) => [...TURBO.slice(3 * i, 3 * i + 3)]) as [
    number[],
    number[],
    number[],
  ];
  expect(Math.max(...low)).toBe(low[2]);
  expect(Math.max(...middle)).toBe(middle[1]);
  expect(Math.max(...high)).toBe(high[0]);
});

it("reads hexadecimal colours", () => {
  expect(parseColor("#ff8000")).toEqual([255, 128, 0]);
  expect(parseColor("nonsense")).toEqual([255, 255, 255]);
});
