import { expect, it } from "vitest";
import { Undoing } from "./undoing";

it("takes back the newest first", async () => {
  const undoing = new Undoing();
  const done: string[] = [];
  const note = (name: string, what: string) => undoing.note(name, what, async () => done.push(`${what} ${name}`));
  note("box", "insert");
  note("ball", "delete");
  expect(undoing.next.value).toBe("delete ball");
  await undoing.take()?.undo();
  await undoing.take()?.undo();
  expect(done).toEqual(["delete ball", "insert box"]);
  expect(undoing.take()).toBeUndefined();
  expect(undoing.next.value).toBe("");
});

it("keeps a hundred", () => {
  const undoing = new Undoing();
  for (let each = 0; each < 150; each++) {
    undoing.note(String(each), "move", async () => undefined);
  }
  let count = 0;
  while (undoing.take()) {
    count++;
  }
  expect(count).toBe(100);
});
