import { expect, it } from "vitest";
import { Backlog } from "./backlog";

const payload = new Uint8Array(1);

it("keeps as many as wished, the newest, and gives them once", () => {
  const backlog = new Backlog();
  backlog.open("/a", 3);
  backlog.open("/b", 1);
  for (let time = 0; time < 10; time++) {
    backlog.add("/a", time, payload);
    backlog.add("/b", time, payload);
    backlog.add("/unknown", time, payload);
  }
  const taken = [...backlog.take()].map(([topic, waiting]) => [topic, waiting.map(({ time }) => time)]);
  expect(taken).toEqual([
    ["/a", [7, 8, 9]],
    ["/b", [9]],
  ]);
  expect(backlog.empty).toBe(true);
  expect([...backlog.take()]).toEqual([]);
});

it("is empty again after closing what was in it", () => {
  const backlog = new Backlog();
  backlog.open("/a", 1);
  backlog.add("/a", 0, payload);
  expect(backlog.empty).toBe(false);
  backlog.close("/a");
  expect(backlog.empty).toBe(true);
});
