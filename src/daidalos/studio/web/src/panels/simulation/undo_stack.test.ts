import { expect, it } from "vitest";
import { UndoStack } from "./undo_stack";

it("takes back the newest first", async () => {
  const undoStack = new UndoStack();
  const done: string[] = [];
  const note = (name: string, what: string) => undoStack.push(name, what, async () => done.push(`${what} ${name}`));
  note("box", "insert");
  note("ball", "delete");
  expect(undoStack.next.value).toBe("delete ball");
  await undoStack.pop()?.undo();
  await undoStack.pop()?.undo();
  expect(done).toEqual(["delete ball", "insert box"]);
  expect(undoStack.pop()).toBeUndefined();
  expect(undoStack.next.value).toBe("");
});

it("keeps a hundred", () => {
  const undoStack = new UndoStack();
  for (let each = 0; each < 150; each++) {
    undoStack.push(String(each), "move", async () => undefined);
  }
  let count = 0;
  while (undoStack.pop()) {
    count++;
  }
  expect(count).toBe(100);
});
