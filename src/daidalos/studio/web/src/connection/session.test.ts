import { beforeEach, expect, it, vi } from "vitest";
import type { FromWorker, ToWorker } from "./boundary";
import { Session } from "./session";

class FakeWorker {
  onmessage: (event: { data: FromWorker }) => void = () => undefined;
  readonly sent: ToWorker[] = [];
  postMessage(message: ToWorker): void {
    this.sent.push(message);
  }
  say(data: FromWorker): void {
    this.onmessage({ data });
  }
}

let worker: FakeWorker;
let session: Session;

beforeEach(() => {
  worker = new FakeWorker();
  session = new Session(worker as unknown as Worker);
});

function batch(topic: string, ...messages: unknown[]): FromWorker {
  return { kind: "batch", messages: messages.map((message, i) => ({ topic, time: i, message })) };
}

it("asks for as many messages as the neediest listener wants", () => {
  const stop = session.subscribe("/a", 5, () => undefined);
  session.subscribe("/a", 2, () => undefined);
  stop();
  stop();
  expect(worker.sent).toEqual([
    { kind: "subscribe", topic: "/a", keep: 5 },
    { kind: "subscribe", topic: "/a", keep: 5 },
    { kind: "subscribe", topic: "/a", keep: 2 },
  ]);
});

it("hands out batches and says when it is ready for more", () => {
  const got: unknown[] = [];
  session.subscribe("/a", 5, (message) => got.push(message));
  worker.say(batch("/a", 1, 2));
  expect(got).toEqual([1, 2]);
  expect(worker.sent.at(-1)).toEqual({ kind: "ready" });
});

it("gives late listeners the newest message", async () => {
  const stop = session.subscribe("/a", 1, () => undefined);
  worker.say(batch("/a", "old", "new"));
  const got: unknown[] = [];
  session.subscribe("/a", 1, (message) => got.push(message));
  await Promise.resolve();
  expect(got).toEqual(["new"]);
  stop();
});

it("unsubscribes with the last listener and forgets", async () => {
  session.subscribe("/a", 1, () => undefined)();
  expect(worker.sent.at(-1)).toEqual({ kind: "unsubscribe", topic: "/a" });
  worker.say(batch("/a", "late"));
  const got: unknown[] = [];
  session.subscribe("/a", 1, (message) => got.push(message));
  await Promise.resolve();
  expect(got).toEqual([]);
});

it("passes on what the clock says, after the messages", () => {
  const order: unknown[] = [];
  session.onClock = ({ robot }) => order.push(robot);
  session.subscribe("/a", 1, (message) => order.push(message));
  const clock = { robot: 7, at: 0, announced: true };
  worker.say({ kind: "batch", clock, messages: [{ topic: "/a", time: 99, message: "first" }] });
  expect(order).toEqual(["first", 7]);
});

it("answers requests with what came or with why not", async () => {
  const asset = session.fetchAsset("package://a/b.stl");
  const call = session.call("/s", {});
  worker.say({ kind: "asset", id: 1, data: new ArrayBuffer(3) });
  worker.say({ kind: "response", id: 2, error: "no" });
  expect((await asset).byteLength).toBe(3);
  await expect(call).rejects.toThrow("no");
});

it("keeps the statuses that have not been withdrawn", () => {
  worker.say({ kind: "status", status: { level: 1, text: "first", id: "a" } });
  worker.say({ kind: "status", status: { level: 1, text: "second", id: "a" } });
  worker.say({ kind: "status", status: { level: 2, text: "other", id: "b" } });
  worker.say({ kind: "removeStatus", ids: ["b"] });
  expect(session.statuses.value.map(({ text }) => text)).toEqual(["second"]);
});

it("notices another server, but not the same one again", () => {
  const renewed = vi.fn();
  session.onNewServer = renewed;
  worker.say({ kind: "server", name: "a", session: "1", hasTime: false });
  worker.say({ kind: "server", name: "a", session: "1", hasTime: true });
  expect(renewed).not.toHaveBeenCalled();
  worker.say({ kind: "server", name: "a", session: "2", hasTime: true });
  expect(renewed).toHaveBeenCalledOnce();
});
