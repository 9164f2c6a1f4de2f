// Who talks to whom: asked of the server while somebody in the page looks at it.
import type { ConnectionGraphUpdate } from "../generated/protocol";
import type { ConnectionGraph } from "./boundary";
import { type Output, toServer } from "./output";

export class GraphWatch {
  private wanted = false;
  private asked = false;
  private offered = false;
  private graph = emptyGraph();

  constructor(private readonly out: Output) {}

  /** Whether the page wants to know; again after `reset`, once the server has said hello. */
  watch(wanted: boolean): void {
    this.wanted = wanted;
    this.ask();
  }

  /** The server can be asked now. */
  greet(offered: boolean): void {
    this.offered = offered;
    this.ask();
  }

  /** The connection is gone; what was known may no longer hold. */
  reset(): void {
    [this.asked, this.offered] = [false, false];
    this.forget();
  }

  update(change: Partial<Omit<ConnectionGraphUpdate, "op">>): void {
    for (const { name, publisherIds } of change.publishedTopics ?? []) {
      put(this.graph.publishers, name, publisherIds);
    }
    for (const { name, subscriberIds } of change.subscribedTopics ?? []) {
      put(this.graph.subscribers, name, subscriberIds);
    }
    for (const { name, providerIds } of change.advertisedServices ?? []) {
      put(this.graph.services, name, providerIds);
    }
    for (const topic of change.removedTopics ?? []) {
      this.graph.publishers.delete(topic);
      this.graph.subscribers.delete(topic);
    }
    for (const service of change.removedServices ?? []) {
      this.graph.services.delete(service);
    }
    this.tell();
  }

  private ask(): void {
    if (this.asked === this.wanted || !this.offered) {
      return;
    }
    this.asked = this.wanted;
    toServer(this.out, { op: this.wanted ? "subscribeConnectionGraph" : "unsubscribeConnectionGraph" });
    if (!this.wanted) {
      this.forget(); // asked again, the server tells everything
    }
  }

  private forget(): void {
    this.graph = emptyGraph();
    this.tell();
  }

  private tell(): void {
    this.out.toPage({ kind: "graph", graph: this.graph satisfies ConnectionGraph });
  }
}

function emptyGraph() {
  return {
    publishers: new Map<string, readonly string[]>(),
    subscribers: new Map<string, readonly string[]>(),
    services: new Map<string, readonly string[]>(),
  };
}

function put(side: Map<string, readonly string[]>, name: string, nodes: readonly string[]): void {
  if (nodes.length) {
    side.set(name, nodes);
  } else {
    side.delete(name);
  }
}
