import { expect, it } from "vitest";
import type { Stamped } from "../contract";
import { toStamp } from "../ros/time";
import { TransformBuffer } from "../tf/buffer";
import { MessageFilter } from "./message_filter";

function message(frame: string, time: number): Stamped {
  return { header: { frame_id: frame, stamp: toStamp(time) } };
}

function move(buffer: TransformBuffer, time: number): void {
  buffer.set(
    {
      header: { frame_id: "map", stamp: toStamp(time) },
      child_frame_id: "base",
      transform: { translation: { x: time, y: 0, z: 0 }, rotation: { x: 0, y: 0, z: 0, w: 1 } },
    },
    false,
  );
}

it("lets messages through when their transform has come", () => {
  const buffer = new TransformBuffer();
  const filter = new MessageFilter();
  move(buffer, 1);
  filter.add(message("base", 1.5), 0);
  filter.add(message("base", 3), 0);
  expect(filter.take(buffer, "map", 0.1)).toEqual([]);
  move(buffer, 2);
  expect(filter.take(buffer, "map", 0.2)).toEqual([message("base", 1.5)]);
  expect(filter.take(buffer, "map", 0.3)).toEqual([]);
  move(buffer, 4);
  expect(filter.take(buffer, "map", 0.4)).toEqual([message("base", 3)]);
  expect(filter.error).toBe("");
});

it("needs no transform in the fixed frame itself, and takes the newest for a stamp of zero", () => {
  const buffer = new TransformBuffer();
  const filter = new MessageFilter();
  filter.add(message("map", 9), 0);
  expect(filter.take(buffer, "map", 0)).toHaveLength(1);
  move(buffer, 5);
  filter.add(message("base", 0), 0);
  expect(filter.take(buffer, "map", 0)).toHaveLength(1);
});

it("gives up after a while and says why", () => {
  const buffer = new TransformBuffer();
  const filter = new MessageFilter();
  filter.add(message("nowhere", 1), 0);
  filter.take(buffer, "map", 1);
  expect(filter.error).toBe("");
  filter.take(buffer, "map", 3);
  expect(filter.error).toContain("does not exist");
});

it("holds only so many", () => {
  const filter = new MessageFilter();
  for (let time = 1; time <= 50; time++) {
    filter.add(message("map", time), 0);
  }
  const taken = filter.take(new TransformBuffer(), "map", 0);
  expect(taken).toHaveLength(10);
  expect(taken.at(-1)).toEqual(message("map", 50));
});
