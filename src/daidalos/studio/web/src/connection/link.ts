// The protocol's state in the worker, independent of the WebSocket.
import { type Channel, type ClientMessage, Level, type ServerMessage } from "../generated/protocol";
import type { ClockReading, Received, ToWorker } from "./boundary";
import { Backlog } from "./backlog";
import { Calls } from "./calls";
import { attempt, emptyMessage, makeReader, type Reader } from "./codecs";
import { parseFrame } from "./frames";
import { GraphWatch } from "./graph_watch";
import { type Output, toServer } from "./output";
import { Publishers } from "./publishers";
import { TrafficMeter } from "./traffic";

/** Frames larger than this are transferred to the page, not copied. */
const TRANSFER_BYTES = 2048;

interface Subscription {
  keep: number;
  /** The subscription's number at the server and the channel it is for; absent while there is no channel. */
  number?: number;
  channel?: number;
}

export class Link {
  private readonly channels = new Map<number, Channel>();
  private readonly subscriptions = new Map<string, Subscription>();
  private readonly topicOf = new Map<number, string>();
  private readonly readers = new Map<string, Reader | Error>();
  private readonly calls: Calls;
  private readonly publishers: Publishers;
  private readonly graph: GraphWatch;
  private readonly backlog = new Backlog();
  private readonly meter = new TrafficMeter();
  private clock: ClockReading | undefined;
  private hasClock = false;
  private numbers = 0;

  constructor(private readonly out: Output) {
    this.calls = new Calls(out);
    this.graph = new GraphWatch(out);
    this.publishers = new Publishers(out, {
      number: () => ++this.numbers,
      definitionOf: (type) => [...this.channels.values()].find((channel) => channel.schemaName === type)?.schema,
    });
  }

  /** Whether there is something to send to the page. */
  get hasUpdate(): boolean {
    return !this.backlog.empty || this.clock !== undefined;
  }

  /** Reset after the connection was lost; subscriptions are kept and opened again. */
  reset(): void {
    this.channels.clear();
    this.topicOf.clear();
    this.publishers.reset();
    this.calls.reset();
    this.graph.reset();
    this.readers.clear();
    this.backlog.clear();
    this.hasClock = false;
    this.clock = undefined;
    for (const subscription of this.subscriptions.values()) {
      delete subscription.number;
      delete subscription.channel;
    }
    this.sendTopics();
  }

  receiveText(text: string): void {
    const message = JSON.parse(text) as ServerMessage;
    switch (message.op) {
      case "serverInfo":
        this.hasClock = message.capabilities.includes("time");
        this.out.toPage({
          kind: "server",
          name: message.name,
          session: message.sessionId ?? "",
          hasTime: this.hasClock,
        });
        this.graph.setOffered(message.capabilities.includes("connectionGraph"));
        break;
      case "advertise":
        for (const channel of message.channels) {
          this.channels.set(channel.id, channel);
          this.readers.delete(channel.topic);
        }
        this.sendTopics();
        this.subscribeWaiting();
        break;
      case "unadvertise":
        this.forgetChannels(new Set(message.channelIds));
        break;
      case "advertiseServices":
        this.calls.offer(message.services);
        break;
      case "unadvertiseServices":
        this.calls.withdraw(message.serviceIds);
        break;
      case "serviceCallFailure":
        this.calls.fail(message.callId, message.message);
        break;
      case "status": {
        const { level, message: text, id } = message;
        this.out.toPage({ kind: "status", status: { level, text, ...(id === undefined ? {} : { id }) } });
        break;
      }
      case "removeStatus":
        this.out.toPage({ kind: "removeStatus", ids: message.statusIds });
        break;
      case "parameterValues":
        this.out.toPage({ kind: "parameters", parameters: message.parameters });
        break;
      case "connectionGraphUpdate":
        this.graph.update(message);
        break;
    }
  }

  receiveBinary(buffer: ArrayBuffer): void {
    const frame = attempt(() => parseFrame(buffer));
    if (frame instanceof Error) {
      // A newer protocol may have other frames: they are skipped.
      this.reportError(frame.message, "frame");
      return;
    }
    switch (frame.op) {
      case "message": {
        const topic = this.topicOf.get(frame.subscription);
        if (topic !== undefined) {
          if (!this.hasClock) {
            this.readClock(frame.time, false);
          }
          this.meter.add(topic, frame.payload.byteLength);
          this.backlog.add(topic, frame.time, frame.payload);
        }
        break;
      }
      case "time":
        this.readClock(frame.time, true);
        break;
      case "serviceResponse":
        this.calls.answer(frame.call, frame.payload);
        break;
      case "asset": {
        const data = frame.data.slice().buffer;
        this.out.toPage({ kind: "asset", id: frame.request, data }, [data]);
        break;
      }
      case "assetError":
        this.out.toPage({ kind: "asset", id: frame.request, error: frame.reason });
        break;
    }
  }

  receivePage(message: ToWorker): void {
    switch (message.kind) {
      case "subscribe":
        this.subscribe(message.topic, message.keep);
        break;
      case "unsubscribe":
        this.unsubscribe(message.topic);
        break;
      case "publish":
        this.publishers.publish(message.topic, message.type, message.message);
        break;
      case "call":
        this.calls.call(message.id, message.service, message.request);
        break;
      case "template":
        this.sendTemplate(message.id, message.of, message.name);
        break;
      case "fetchAsset":
        this.send({ op: "fetchAsset", requestId: message.id, uri: message.uri });
        break;
      case "getParameters":
        this.send({ op: "getParameters", parameterNames: message.names, id: "page" });
        break;
      case "setParameters":
        this.send({ op: "setParameters", parameters: message.parameters, id: "page" });
        break;
      case "watchGraph":
        this.graph.watch(message.on);
        break;
    }
  }

  /** Decode the waiting messages and send them to the page. */
  flush(): void {
    const messages: Received[] = [];
    const transfer: ArrayBuffer[] = [];
    for (const [topic, waiting] of this.backlog.take()) {
      const read = this.readerOf(topic);
      if (!read) {
        continue;
      }
      for (const { time, payload } of waiting) {
        try {
          messages.push({ topic, time, message: read(payload) });
          if (payload.byteLength > TRANSFER_BYTES) {
            transfer.push(payload.buffer as ArrayBuffer);
          }
        } catch (error) {
          this.reportError(`${topic}: a message cannot be read: ${String(error)}`, `read:${topic}`);
        }
      }
    }
    const clock = this.clock;
    this.clock = undefined;
    this.out.toPage({ kind: "batch", messages, ...(clock ? { clock } : {}) }, transfer);
  }

  /** Send the page the rates of its subscriptions. */
  measure(now: number): void {
    this.out.toPage({ kind: "traffic", traffic: this.meter.measure(now) });
  }

  private readClock(robot: number, announced: boolean): void {
    this.clock = { robot, at: performance.timeOrigin + performance.now(), announced };
  }

  private subscribe(topic: string, keep: number): void {
    const known = this.subscriptions.get(topic);
    const subscription = known ?? { keep };
    const wasCountedOnly = known?.keep === 0 && keep > 0;
    subscription.keep = keep;
    this.subscriptions.set(topic, subscription);
    this.backlog.open(topic, keep);
    this.meter.open(topic, performance.now() / 1000);
    if (wasCountedOnly && subscription.number !== undefined) {
      // Latched messages were only counted when they arrived: subscribe again to get them.
      // Servers may refuse a second subscription to a channel, so the first one ends before.
      this.disconnect(subscription.number);
      delete subscription.number;
    }
    if (subscription.number === undefined) {
      this.connect(topic, subscription);
    }
  }

  private connect(topic: string, subscription: Subscription): void {
    const channel = this.channelOf(topic);
    if (!channel) {
      return;
    }
    const number = ++this.numbers;
    subscription.number = number;
    subscription.channel = channel.id;
    this.topicOf.set(number, topic);
    this.send({ op: "subscribe", subscriptions: [{ id: number, channelId: channel.id }] });
  }

  private disconnect(number: number): void {
    this.topicOf.delete(number);
    this.send({ op: "unsubscribe", subscriptionIds: [number] });
  }

  private unsubscribe(topic: string): void {
    const subscription = this.subscriptions.get(topic);
    this.subscriptions.delete(topic);
    this.backlog.close(topic);
    this.meter.close(topic);
    if (subscription?.number !== undefined) {
      this.disconnect(subscription.number);
    }
  }

  private subscribeWaiting(): void {
    for (const [topic, subscription] of this.subscriptions) {
      if (subscription.number === undefined) {
        this.connect(topic, subscription);
      }
    }
  }

  private forgetChannels(gone: Set<number>): void {
    for (const id of gone) {
      this.channels.delete(id);
    }
    for (const subscription of this.subscriptions.values()) {
      if (subscription.number !== undefined && gone.has(subscription.channel ?? -1)) {
        this.topicOf.delete(subscription.number);
        delete subscription.number;
        delete subscription.channel;
      }
    }
    this.sendTopics();
    this.subscribeWaiting();
  }

  private channelOf(topic: string): Channel | undefined {
    // Two types of one name are an error in the graph; the first one is used.
    for (const channel of this.channels.values()) {
      if (channel.topic === topic) {
        return channel;
      }
    }
    return undefined;
  }

  private readerOf(topic: string): Reader | undefined {
    let reader = this.readers.get(topic);
    if (!reader) {
      const channel = this.channelOf(topic);
      if (!channel) {
        return undefined;
      }
      reader = attempt(() => makeReader(channel.schema));
      this.readers.set(topic, reader);
      if (reader instanceof Error && channel.schemaEncoding !== undefined) {
        this.reportError(`${topic}: the definition of ${channel.schemaName} cannot be read: ${reader.message}`);
      }
    }
    return reader instanceof Error ? undefined : reader;
  }

  private sendTemplate(id: number, of: "service" | "topic", name: string): void {
    const definition = of === "service" ? this.calls.requestOf(name) : this.channelOf(name)?.schema;
    const message =
      definition === undefined ? new Error(`there is no ${of} ${name}`) : attempt(() => emptyMessage(definition));
    this.out.toPage({ kind: "response", id, ...(message instanceof Error ? { error: message.message } : { message }) });
  }

  private sendTopics(): void {
    const topics = [...this.channels.values()].map((channel) => ({
      name: channel.topic,
      type: channel.schemaName,
      known: channel.schemaEncoding !== undefined,
    }));
    topics.sort((a, b) => a.name.localeCompare(b.name));
    this.out.toPage({ kind: "topics", topics });
  }

  private reportError(text: string, id?: string): void {
    this.out.toPage({ kind: "status", status: { level: Level.WARNING, text, ...(id === undefined ? {} : { id }) } });
  }

  private send(message: ClientMessage): void {
    toServer(this.out, message);
  }
}
