import { beforeEach, describe, expect, it } from "vitest";
import type { FromWorker } from "./boundary";
import { makeReader, makeWriter } from "./codecs";
import { Link } from "./link";

const STRING = "string data";

let toServer: (string | Uint8Array)[];
let toPage: FromWorker[];
let link: Link;

beforeEach(() => {
  [toServer, toPage] = [[], []];
  link = new Link({ toServer: (frame) => toServer.push(frame), toPage: (message) => toPage.push(message) });
});

function advertise(id: number, topic: string, schema = STRING, schemaName = "std_msgs/msg/String"): void {
  link.receiveText(
    JSON.stringify({
      op: "advertise",
      channels: [{ id, topic, encoding: "cdr", schemaName, schema, schemaEncoding: "ros2msg" }],
    }),
  );
}

function said(op: string): Record<string, unknown>[] {
  return toServer
    .filter((frame): frame is string => typeof frame === "string")
    .map((frame) => JSON.parse(frame) as Record<string, unknown>)
    .filter((message) => message.op === op);
}

function received<K extends FromWorker["kind"]>(kind: K): Extract<FromWorker, { kind: K }>[] {
  return toPage.filter((message): message is Extract<FromWorker, { kind: K }> => message.kind === kind);
}

function message(subscription: number, text: string): ArrayBuffer {
  const payload = makeWriter(STRING)({ data: text });
  const frame = new Uint8Array(13 + payload.byteLength);
  const view = new DataView(frame.buffer);
  view.setUint8(0, 1);
  view.setUint32(1, subscription, true);
  view.setBigUint64(5, 3_000_000_000n, true);
  frame.set(payload, 13);
  return frame.buffer;
}

function subscription(index = 0): number {
  return (said("subscribe")[index] as { subscriptions: { id: number }[] }).subscriptions[0]?.id as number;
}

describe("subscriptions", () => {
  it("wait for their topic", () => {
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 1 });
    expect(toServer).toEqual([]);
    advertise(4, "/a");
    expect(said("subscribe")).toEqual([{ op: "subscribe", subscriptions: [{ id: subscription(), channelId: 4 }] }]);
  });

  it("decode, and keep the newest in order", () => {
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 2 });
    for (const text of ["one", "two", "three"]) {
      link.receiveBinary(message(subscription(), text));
    }
    expect(link.hasUpdate).toBe(true);
    link.flush();
    expect(received("batch")[0]?.messages).toEqual([
      { topic: "/a", time: 3, message: { data: "two" } },
      { topic: "/a", time: 3, message: { data: "three" } },
    ]);
    expect(link.hasUpdate).toBe(false);
  });

  it("with nothing to keep are counted only", () => {
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 0 });
    link.receiveBinary(message(subscription(), "x"));
    link.flush();
    expect(received("batch")[0]?.messages).toEqual([]);
    link.measure(performance.now() / 1000 + 1);
    expect(received("traffic").at(-1)?.traffic["/a"]?.total).toBe(1);
  });

  it("of one more listener change nothing at the server", () => {
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 1 });
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 3 });
    expect(toServer).toHaveLength(1);
  });

  it("that were only counted begin anew when someone looks, one after the other", () => {
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 0 });
    const first = subscription();
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 1 });
    const order = toServer.map((frame) => (JSON.parse(frame as string) as { op: string }).op);
    expect(order).toEqual(["subscribe", "unsubscribe", "subscribe"]);
    expect(said("unsubscribe")).toEqual([{ op: "unsubscribe", subscriptionIds: [first] }]);
  });

  it("follow a topic to its new channel and over a new connection", () => {
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 1 });
    link.receiveText(JSON.stringify({ op: "unadvertise", channelIds: [4] }));
    advertise(5, "/a", "int32 data", "std_msgs/msg/Int32");
    expect(said("subscribe")).toHaveLength(2);
    link.reset();
    expect(received("topics").at(-1)?.topics).toEqual([]);
    advertise(1, "/a");
    expect(said("subscribe")).toHaveLength(3);
    link.receiveBinary(message(subscription(2), "again"));
    link.flush();
    expect(received("batch").at(-1)?.messages[0]?.message).toEqual({ data: "again" });
  });

  it("reports an error for messages that cannot be read and goes on", () => {
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 4 });
    link.receiveBinary(message(subscription(), "good").slice(0, 19));
    link.receiveBinary(message(subscription(), "good"));
    link.flush();
    expect(received("status")[0]?.status.text).toContain("/a");
    expect(received("batch")[0]?.messages).toHaveLength(1);
  });
});

describe("robot time", () => {
  const time = (seconds: number) => {
    const frame = new DataView(new ArrayBuffer(9));
    frame.setUint8(0, 2);
    frame.setBigUint64(1, BigInt(seconds) * 1_000_000_000n, true);
    return frame.buffer;
  };

  it("is what the server's clock says", () => {
    link.receiveText(JSON.stringify({ op: "serverInfo", name: "s", capabilities: ["time"] }));
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 1 });
    link.receiveBinary(time(8));
    link.receiveBinary(message(subscription(), "later"));
    link.flush();
    expect(received("batch")[0]?.clock).toMatchObject({ robot: 8, announced: true });
    expect(Math.abs((received("batch")[0]?.clock?.at ?? 0) - Date.now())).toBeLessThan(5000);
  });

  it("is that of the newest message where the server has no clock", () => {
    link.receiveText(JSON.stringify({ op: "serverInfo", name: "s", capabilities: [] }));
    advertise(4, "/a");
    link.receivePage({ kind: "subscribe", topic: "/a", keep: 0 });
    link.receiveBinary(message(subscription(), "x"));
    expect(link.hasUpdate).toBe(true);
    link.flush();
    expect(received("batch")[0]?.clock).toMatchObject({ robot: 3, announced: false });
  });
});

it("frames that are not understood are told and do not stop the rest", () => {
  link.receiveBinary(new Uint8Array([99]).buffer);
  expect(received("status")[0]?.status.text).toContain("99");
});

describe("publishing", () => {
  it("advertises once and writes what others can read", () => {
    for (const x of [1, 2]) {
      link.receivePage({
        kind: "publish",
        topic: "/clicked_point",
        type: "geometry_msgs/msg/PointStamped",
        message: { header: { stamp: { sec: 1, nanosec: 2 }, frame_id: "map" }, point: { x, y: 0, z: 0 } },
      });
    }
    const channels = (said("advertise")[0] as { channels: { id: number; schema: string }[] }).channels;
    expect(said("advertise")).toHaveLength(1);
    const frames = toServer.filter((frame): frame is Uint8Array => typeof frame !== "string");
    expect(frames).toHaveLength(2);
    const read = makeReader(channels[0]?.schema as string)((frames[1] as Uint8Array).slice(5));
    expect(read).toMatchObject({ header: { frame_id: "map" }, point: { x: 2 } });
    expect(received("published").map(({ error }) => error)).toEqual([undefined, undefined]);
  });

  it("tells when a type is not known", () => {
    link.receivePage({ kind: "publish", topic: "/x", type: "a/msg/B", message: {} });
    expect(received("published")[0]?.error).toContain("a/msg/B");
  });
});

describe("services", () => {
  const offer = () =>
    link.receiveText(
      JSON.stringify({
        op: "advertiseServices",
        services: [
          { id: 3, name: "/s", type: "p/srv/S", request: { schema: STRING }, response: { schema: "bool ok" } },
        ],
      }),
    );

  it("are called and answer", () => {
    offer();
    link.receivePage({ kind: "call", id: 8, service: "/s", request: { data: "do" } });
    const answer = new Uint8Array([3, 3, 0, 0, 0, 8, 0, 0, 0, 3, 0, 0, 0, 99, 100, 114, 0, 1, 0, 0, 1]);
    link.receiveBinary(answer.buffer);
    expect(received("response")).toEqual([{ kind: "response", id: 8, message: { ok: true } }]);
  });

  it("fail in words", () => {
    link.receivePage({ kind: "call", id: 1, service: "/none", request: {} });
    offer();
    link.receivePage({ kind: "call", id: 2, service: "/s", request: { data: "do" } });
    link.receiveText(JSON.stringify({ op: "serviceCallFailure", serviceId: 3, callId: 2, message: "no" }));
    link.receivePage({ kind: "call", id: 3, service: "/s", request: { data: "do" } });
    link.reset();
    expect(received("response").map(({ id, error }) => [id, error])).toEqual([
      [1, "there is no service /none"],
      [2, "no"],
      [3, "the connection was lost"],
    ]);
  });
});
