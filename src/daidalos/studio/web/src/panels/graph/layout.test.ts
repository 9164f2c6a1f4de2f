import { expect, it } from "vitest";
import { curve, fromSideToSide } from "./layout";

it("lets lines end in the middle of the sides that face each other", () => {
  const [left, right] = [
    { x: 50, y: 20, width: 40, height: 30 },
    { x: 250, y: 80, width: 60, height: 30 },
  ];
  const inner = [{ x: 150, y: 40 }];
  const points = [{ x: 55, y: 35 }, ...inner, { x: 240, y: 65 }];
  expect(fromSideToSide(points, left, right)).toEqual([{ x: 70, y: 20 }, ...inner, { x: 220, y: 80 }]);
  expect(fromSideToSide([...points].reverse(), right, left)).toEqual([{ x: 220, y: 80 }, ...inner, { x: 70, y: 20 }]);
});

it("leaves and arrives level", () => {
  expect(
    curve([
      { x: 0, y: 0 },
      { x: 10, y: 6 },
    ]),
  ).toBe("M0,0C5,0 5,6 10,6");
  expect(curve([])).toBe("");
});
