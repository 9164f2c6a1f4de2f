import { Box3, Vector3 } from "three";
import { expect, test, vi } from "vitest";
import { FirstView } from "./first_view";
import type { View } from "./view";

const box = (x: number, y: number, size: number) =>
  new Box3(new Vector3(x, y, 0), new Vector3(x + size, y + size, size));

function scene(robot: Box3) {
  const restore = vi.fn();
  const content = { all: box(-5, -5, 10), robot };
  const first = new FirstView({ restore, isMoved: false } as unknown as View, () => content);
  return { restore, content, first };
}

test("a robot that drives within what is shown does not move the view", () => {
  const { restore, content, first } = scene(box(0, 0, 0.5));
  for (let now = 1; now < 4; now += 0.5) {
    content.robot = box(now, 0, 0.5 + 0.1 * Math.sin(now));
    first.update(now, 1.5);
  }
  expect(restore).toHaveBeenCalledTimes(1);
  expect(first.isSettled).toBe(true);
});

test("a robot that appears later, or gets more parts, is framed", () => {
  const { restore, content, first } = scene(new Box3());
  first.update(1, 1.5);
  content.robot = box(0, 0, 0.2);
  first.update(2, 1.5);
  content.robot = box(0, 0, 1);
  first.update(3, 1.5);
  expect(restore).toHaveBeenCalledTimes(3);
  expect(first.isSettled).toBe(false);
});

test("a map that grows is framed until the longest time is over", () => {
  const { restore, content, first } = scene(new Box3());
  for (let now = 1; now < 20; now++) {
    content.all = box(0, 0, 2 ** now);
    first.update(now, 1.5);
  }
  expect(restore).toHaveBeenCalledTimes(14);
  expect(first.isSettled).toBe(true);
});
