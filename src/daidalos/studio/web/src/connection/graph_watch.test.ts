import { beforeEach, describe, expect, it } from "vitest";
import type { ConnectionGraph, FromWorker } from "./boundary";
import { GraphWatch } from "./graph_watch";

let toServer: string[];
let told: ConnectionGraph[];
let watch: GraphWatch;

beforeEach(() => {
  [toServer, told] = [[], []];
  watch = new GraphWatch({
    toServer: (frame) => toServer.push((JSON.parse(frame as string) as { op: string }).op),
    toPage: (message: FromWorker) => message.kind === "graph" && told.push(structuredClone(message.graph)),
  });
});

describe("the connection graph", () => {
  it("is asked for once the server can be asked, and again after the connection was lost", () => {
    watch.watch(true);
    expect(toServer).toEqual([]);
    watch.setOffered(true);
    watch.setOffered(true);
    expect(toServer).toEqual(["subscribeConnectionGraph"]);
    watch.reset();
    watch.setOffered(true);
    watch.watch(false);
    expect(toServer).toEqual(["subscribeConnectionGraph", "subscribeConnectionGraph", "unsubscribeConnectionGraph"]);
  });

  it("is not asked of servers that do not offer it", () => {
    watch.setOffered(false);
    watch.watch(true);
    expect(toServer).toEqual([]);
  });

  it("follows what changes", () => {
    watch.setOffered(true);
    watch.watch(true);
    watch.update({
      publishedTopics: [{ name: "/a", publisherIds: ["/talker"] }],
      subscribedTopics: [{ name: "/a", subscriberIds: ["/listener"] }],
      advertisedServices: [{ name: "/clear", providerIds: ["/talker"] }],
    });
    expect(told.at(-1)).toEqual({
      publishers: new Map([["/a", ["/talker"]]]),
      subscribers: new Map([["/a", ["/listener"]]]),
      services: new Map([["/clear", ["/talker"]]]),
    });
    watch.update({ publishedTopics: [{ name: "/a", publisherIds: [] }], removedServices: ["/clear"] });
    expect(told.at(-1)).toEqual({
      publishers: new Map(),
      subscribers: new Map([["/a", ["/listener"]]]),
      services: new Map(),
    });
    watch.update({ removedTopics: ["/a"] });
    expect(told.at(-1)?.subscribers.size).toBe(0);
  });
});
