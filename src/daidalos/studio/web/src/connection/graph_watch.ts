// The connection graph: requested from the server while the page shows it.
import type { ConnectionGraphUpdate } from "../generated/protocol";
import type { ConnectionGraph } from "./boundary";
import { type Output, toServer } from "./output";

export class GraphWatch {
  private wanted = false;
  private requested = false;
  private offered = false;
  private graph = emptyGraph();

  constructor(private readonly out: Output) {}

  /** Set whether the page needs the graph; it is requested again after `reset`. */
  watch(wanted: boolean): void {
    this.wanted = wanted;
    this.request();
  }

  /** Set whether the server offers the graph. */
  setOffered(offered: boolean): void {
    this.offered = offered;
    this.request();
  }

  /** Reset after the connection was lost. */
  reset(): void {
    [this.requested, this.offered] = [false, false];
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
    this.publish();
  }

  private request(): void {
    if (this.requested === this.wanted || !this.offered) {
      return;
    }
    this.requested = this.wanted;
    toServer(this.out, { op: this.wanted ? "subscribeConnectionGraph" : "unsubscribeConnectionGraph" });
    if (!this.wanted) {
      this.forget(); // requested again, the server sends the whole graph
    }
  }

  private forget(): void {
    this.graph = emptyGraph();
    this.publish();
  }

  private publish(): void {
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
