import { expect, it } from "vitest";
import { Undoing } from "./undoing";

it("takes back the newest first, and nothing of what is gone", async () => {
  const undoing = new Undoing();
  const done: string[] = [];
  const note = (name: string, what: string) => undoing.note(name, what, async () => done.push(`${what} ${name}`));
  note("box", "insert");
  note("ball", "insert");
  note("box", "move");
  expect(undoing.next.value).toBe("move box");
  await undoing.take()?.undo();
  undoing.forget("ball");
  await undoing.take()?.undo();
  expect(done).toEqual(["move box", "insert box"]);
  expect(undoing.take()).toBeUndefined();
  expect(undoing.next.value).toBe("");
});
