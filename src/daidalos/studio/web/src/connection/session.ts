// The page's side of the connection: the graph's topics and services, and the page's subscriptions.
import { signal } from "@preact/signals";
import type {
  ClockReading,
  ConnectionGraph,
  FromWorker,
  LinkState,
  Received,
  StatusInfo,
  ToWorker,
  Traffic,
} from "./boundary";
import type { ServiceInfo, TopicInfo } from "../contract";
import type * as contract from "../contract";
import type { ParameterEntry } from "../generated/protocol";
import type { Outgoing, ServiceType } from "../contract";

export type Listener<M> = (message: M, time: number) => void;

export interface Publishing {
  topic: string;
  error?: string;
}

interface Subscriber {
  keep: number;
  received: Listener<never>;
}

export class Session implements contract.Session {
  readonly link = signal<LinkState>("connecting");
  readonly serverName = signal("");
  readonly topics = signal<TopicInfo[]>([]);
  readonly services = signal<ServiceInfo[]>([]);
  readonly traffic = signal<Record<string, Traffic>>({});
  readonly statuses = signal<(StatusInfo & { key: number })[]>([]);
  readonly parameters = signal<ReadonlyMap<string, ParameterEntry>>(new Map());
  /** Publishers, subscribers and servers, while `watchGraph` is active. */
  readonly graph = signal<ConnectionGraph | undefined>(undefined);
  readonly lastPublished = signal<Publishing | undefined>(undefined);

  /** Called when robot time moves. */
  onClock: (reading: ClockReading) => void = () => undefined;
  /** Called when the server is another than before, so that nothing of the old one may stay. */
  onNewServer: () => void = () => undefined;

  private readonly subscribers = new Map<string, Set<Subscriber>>();
  /** The newest message of each topic, for later subscribers: latched ones are not sent again. */
  private readonly latest = new Map<string, Received>();
  private readonly requests = new Map<number, (message: FromWorker) => void>();
  private server = "";
  private numbers = 0;
  private graphWatchers = 0;

  constructor(private readonly worker: Worker) {
    worker.onmessage = (event: MessageEvent<FromWorker>) => this.receive(event.data);
  }

  /** Set whether the page is visible: batches are longer while it is hidden. */
  setVisible(visible: boolean): void {
    this.send({ kind: "visible", visible });
  }

  open(url: string): void {
    this.send({ kind: "open", url });
  }

  /** Listen to a topic, existing or not; keep this many messages when the page cannot follow. */
  subscribe<M>(topic: string, keep: number, received: Listener<M>): () => void {
    const subscriber: Subscriber = { keep, received: received as Listener<never> };
    const others = this.subscribers.get(topic) ?? new Set();
    this.subscribers.set(topic, others.add(subscriber));
    this.send({ kind: "subscribe", topic, keep: maxKept(others) });
    const latest = this.latest.get(topic);
    if (latest && keep > 0) {
      queueMicrotask(() => {
        if (others.has(subscriber)) {
          received(latest.message as M, latest.time);
        }
      });
    }
    return () => {
      if (!others.delete(subscriber)) {
        return;
      }
      if (others.size > 0) {
        this.send({ kind: "subscribe", topic, keep: maxKept(others) });
      } else if (this.subscribers.get(topic) === others) {
        this.subscribers.delete(topic);
        this.latest.delete(topic);
        this.send({ kind: "unsubscribe", topic });
      }
    };
  }

  publish(topic: string, type: string, message: unknown): void {
    this.send({ kind: "publish", topic, type, message });
  }

  call<S extends ServiceType>(service: string, request: Outgoing<S["Request"]>): Promise<S["Response"]> {
    return this.askFor((id) => ({ kind: "call", id, service, request }));
  }

  /** A request of a service, or a message of a topic, with nothing filled in. */
  template(of: "service" | "topic", name: string): Promise<unknown> {
    return this.askFor((id) => ({ kind: "template", id, of, name }));
  }

  private async askFor(build: (id: number) => ToWorker): Promise<unknown> {
    const answer = await this.ask(build);
    if (answer.kind !== "response" || answer.error !== undefined) {
      throw new Error(answer.kind === "response" ? answer.error : "no answer");
    }
    return answer.message;
  }

  async fetchAsset(uri: string): Promise<ArrayBuffer> {
    const answer = await this.ask((id) => ({ kind: "fetchAsset", id, uri }));
    if (answer.kind !== "asset" || !answer.data) {
      throw new Error(answer.kind === "asset" ? answer.error : "no answer");
    }
    return answer.data;
  }

  readParameters(names: string[] = []): void {
    this.send({ kind: "getParameters", names });
  }

  setParameters(parameters: readonly ParameterEntry[]): void {
    this.send({ kind: "setParameters", parameters });
  }

  /** Keep `graph` up to date until the returned function is called. */
  watchGraph(): () => void {
    if (this.graphWatchers++ === 0) {
      this.send({ kind: "watchGraph", on: true });
    }
    let watches = true;
    return () => {
      if (watches && --this.graphWatchers === 0) {
        this.send({ kind: "watchGraph", on: false });
        this.graph.value = undefined;
      }
      watches = false;
    };
  }

  /** The type of a topic, where it exists. */
  typeOf(topic: string): string | undefined {
    return this.topics.value.find((each) => each.name === topic)?.type;
  }

  private deliver(newest: Received): void {
    const { topic, time, message } = newest;
    if (this.subscribers.has(topic)) {
      this.latest.set(topic, newest);
    }
    for (const subscriber of this.subscribers.get(topic) ?? []) {
      subscriber.received(message as never, time);
    }
  }

  private ask(build: (id: number) => ToWorker): Promise<FromWorker> {
    const id = ++this.numbers;
    return new Promise((resolve) => {
      this.requests.set(id, resolve);
      this.send(build(id));
    });
  }

  private answer(id: number, message: FromWorker): void {
    this.requests.get(id)?.(message);
    this.requests.delete(id);
  }

  private receive(message: FromWorker): void {
    switch (message.kind) {
      case "batch":
        // At once: the next frame shows the newest message.
        for (const received of message.messages) {
          this.deliver(received);
        }
        if (message.clock) {
          this.onClock(message.clock);
        }
        this.send({ kind: "ready" });
        break;
      case "link":
        this.link.value = message.state;
        if (message.state === "lost") {
          this.latest.clear();
        }
        break;
      case "server":
        this.serverName.value = message.name;
        if (this.server !== message.session) {
          if (this.server) {
            this.onNewServer();
            this.statuses.value = [];
          }
          this.server = message.session;
        }
        break;
      case "topics":
        this.topics.value = message.topics;
        break;
      case "services":
        this.services.value = message.services;
        break;
      case "traffic":
        this.traffic.value = message.traffic;
        break;
      case "status":
        this.addStatus(message.status);
        break;
      case "removeStatus":
        this.statuses.value = this.statuses.value.filter((each) => !message.ids.includes(each.id ?? ""));
        break;
      case "published":
        this.lastPublished.value = message;
        if (message.error !== undefined) {
          this.addStatus({ level: 2, text: `${message.topic}: ${message.error}` });
        }
        break;
      case "response":
      case "asset":
        this.answer(message.id, message);
        break;
      case "parameters": {
        const known = new Map(this.parameters.value);
        for (const parameter of message.parameters) {
          known.set(parameter.name, parameter);
        }
        this.parameters.value = known;
        break;
      }
      case "graph":
        this.graph.value = this.graphWatchers ? message.graph : undefined;
        break;
    }
  }

  /** Show a status to the user. */
  addStatus(status: StatusInfo): void {
    const others = this.statuses.value.filter((each) => status.id === undefined || each.id !== status.id);
    this.statuses.value = [...others.slice(-49), { ...status, key: ++this.numbers }];
  }

  private send(message: ToWorker): void {
    this.worker.postMessage(message);
  }
}

function maxKept(subscribers: Iterable<Subscriber>): number {
  let kept = 0;
  for (const { keep } of subscribers) {
    kept = Math.max(kept, keep);
  }
  return kept;
}
