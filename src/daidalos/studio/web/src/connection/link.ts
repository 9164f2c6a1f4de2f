// The worker's conversation with the server: the protocol's state, independent of what carries it.
import type { FromWorker, ParameterInfo, Received, ToWorker } from "./boundary";
import { Backlog } from "./backlog";
import { makeReader, makeWriter, type Reader, type Writer } from "./codecs";
import { parseFrame, publishFrame, serviceRequestFrame, type ServerFrame } from "./frames";
import { TrafficMeter } from "./traffic";
import { DEFINITIONS } from "../ros/definitions";

/** Frames larger than this are handed to the page, not copied. */
const TRANSFER_BYTES = 2048;

export interface Channel {
  id: number;
  topic: string;
  schemaName: string;
  schema: string;
  schemaEncoding?: string;
}

interface Service {
  id: number;
  name: string;
  type: string;
  request?: { schema: string };
  response?: { schema: string };
  requestSchema?: string;
  responseSchema?: string;
}

type ServerMessage =
  | { op: "serverInfo"; name: string; sessionId?: string; capabilities: string[] }
  | { op: "advertise"; channels: Channel[] }
  | { op: "unadvertise"; channelIds: number[] }
  | { op: "advertiseServices"; services: Service[] }
  | { op: "unadvertiseServices"; serviceIds: number[] }
  | { op: "serviceCallFailure"; serviceId: number; callId: number; message: string }
  | { op: "status"; level: number; message: string; id?: string }
  | { op: "removeStatus"; statusIds: string[] }
  | { op: "parameterValues"; parameters: ParameterInfo[] };

interface Subscription {
  keep: number;
  /** The subscription's number at the server and the channel it is for; absent while there is no channel. */
  number?: number;
  channel?: number;
}

export interface Output {
  toServer(frame: string | Uint8Array<ArrayBuffer>): void;
  toPage(message: FromWorker, transfer?: Transferable[]): void;
}

export class Link {
  private readonly channels = new Map<number, Channel>();
  private readonly services = new Map<number, Service>();
  private readonly subscriptions = new Map<string, Subscription>();
  private readonly topicOf = new Map<number, string>();
  private readonly readers = new Map<string, Reader | Error>();
  private readonly writers = new Map<string, { number: number; write: Writer }>();
  private readonly calls = new Map<number, Service>();
  private readonly backlog = new Backlog();
  private readonly meter = new TrafficMeter();
  private time: number | undefined;
  private hasClock = false;
  private numbers = 0;

  constructor(private readonly out: Output) {}

  /** Whether the page has something to take. */
  get hasNews(): boolean {
    return !this.backlog.empty || this.time !== undefined;
  }

  /** The connection is gone; what the page wants stays, to be asked for again. */
  reset(): void {
    this.channels.clear();
    this.services.clear();
    this.topicOf.clear();
    this.writers.clear();
    this.readers.clear();
    this.backlog.clear();
    this.hasClock = false;
    this.time = undefined;
    for (const id of this.calls.keys()) {
      this.out.toPage({ kind: "response", id, error: "the connection was lost" });
    }
    this.calls.clear();
    for (const subscription of this.subscriptions.values()) {
      delete subscription.number;
      delete subscription.channel;
    }
    this.tellTopics();
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
        break;
      case "advertise":
        for (const channel of message.channels) {
          this.channels.set(channel.id, channel);
          this.readers.delete(channel.topic);
        }
        this.tellTopics();
        this.subscribeWaiting();
        break;
      case "unadvertise":
        this.forgetChannels(new Set(message.channelIds));
        break;
      case "advertiseServices":
        for (const service of message.services) {
          this.services.set(service.id, service);
        }
        this.tellServices();
        break;
      case "unadvertiseServices":
        for (const id of message.serviceIds) {
          this.services.delete(id);
        }
        this.tellServices();
        break;
      case "serviceCallFailure":
        this.calls.delete(message.callId);
        this.out.toPage({ kind: "response", id: message.callId, error: message.message });
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
    }
  }

  receiveBinary(buffer: ArrayBuffer): void {
    const frame = parseFrame(buffer);
    switch (frame.op) {
      case "message": {
        const topic = this.topicOf.get(frame.subscription);
        if (topic !== undefined) {
          this.meter.add(topic, frame.payload.byteLength);
          this.backlog.add(topic, frame.time, frame.payload);
        }
        break;
      }
      case "time":
        this.time = frame.time;
        break;
      case "serviceResponse":
        this.answerCall(frame);
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
        this.publish(message.topic, message.type, message.message);
        break;
      case "call":
        this.call(message.id, message.service, message.request);
        break;
      case "fetchAsset":
        this.say({ op: "fetchAsset", requestId: message.id, uri: message.uri });
        break;
      case "getParameters":
        this.say({ op: "getParameters", parameterNames: message.names, id: "page" });
        break;
      case "setParameters":
        this.say({ op: "setParameters", parameters: message.parameters, id: "page" });
        break;
    }
  }

  /** Decode what waits and hand it to the page. */
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
          this.complain(`${topic}: a message can not be read: ${String(error)}`, `read:${topic}`);
        }
      }
    }
    const time = this.time;
    this.time = undefined;
    this.out.toPage(
      { kind: "batch", messages, hasClock: this.hasClock, ...(time === undefined ? {} : { time }) },
      transfer,
    );
  }

  /** Tell the page the rates of what it subscribed to. */
  measure(now: number): void {
    this.out.toPage({ kind: "traffic", traffic: this.meter.measure(now) });
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
      // What is kept for late listeners was not looked at when it came: ask for it again.
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
    this.say({ op: "subscribe", subscriptions: [{ id: number, channelId: channel.id }] });
  }

  private disconnect(number: number): void {
    this.topicOf.delete(number);
    this.say({ op: "unsubscribe", subscriptionIds: [number] });
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
    this.tellTopics();
    this.subscribeWaiting();
  }

  private channelOf(topic: string): Channel | undefined {
    // Two types on one name are a mistake in the graph; the first one stays.
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
        this.complain(`${topic}: the definition of ${channel.schemaName} can not be read: ${reader.message}`);
      }
    }
    return reader instanceof Error ? undefined : reader;
  }

  private publish(topic: string, type: string, message: unknown): void {
    const done = attempt(() => {
      const writer = this.writerFor(topic, type);
      this.out.toServer(publishFrame(writer.number, writer.write(message)));
    });
    this.out.toPage({ kind: "published", topic, ...(done instanceof Error ? { error: done.message } : {}) });
  }

  private writerFor(topic: string, type: string): { number: number; write: Writer } {
    const key = `${topic} ${type}`;
    let writer = this.writers.get(key);
    if (!writer) {
      const known = [...this.channels.values()].find((channel) => channel.schemaName === type);
      const definition = known?.schema ?? DEFINITIONS[type];
      if (definition === undefined) {
        throw new Error(`the definition of ${type} is not known here`);
      }
      writer = { number: ++this.numbers, write: makeWriter(definition) };
      this.writers.set(key, writer);
      this.say({
        op: "advertise",
        channels: [
          {
            id: writer.number,
            topic,
            encoding: "cdr",
            schemaName: type,
            schema: definition,
            schemaEncoding: "ros2msg",
          },
        ],
      });
    }
    return writer;
  }

  private call(id: number, name: string, request: unknown): void {
    const service = [...this.services.values()].find((each) => each.name === name);
    if (!service) {
      this.out.toPage({ kind: "response", id, error: `there is no service ${name}` });
      return;
    }
    const done = attempt(() => {
      const write = makeWriter(service.request?.schema ?? service.requestSchema ?? "");
      this.out.toServer(serviceRequestFrame(service.id, id, write(request)));
    });
    if (done instanceof Error) {
      this.out.toPage({ kind: "response", id, error: done.message });
    } else {
      this.calls.set(id, service);
    }
  }

  private answerCall(frame: Extract<ServerFrame, { op: "serviceResponse" }>): void {
    const service = this.calls.get(frame.call);
    this.calls.delete(frame.call);
    if (service) {
      const message = attempt(() =>
        makeReader(service.response?.schema ?? service.responseSchema ?? "")(frame.payload),
      );
      this.out.toPage({
        kind: "response",
        id: frame.call,
        ...(message instanceof Error ? { error: message.message } : { message }),
      });
    }
  }

  private tellTopics(): void {
    const topics = [...this.channels.values()].map((channel) => ({
      name: channel.topic,
      type: channel.schemaName,
      known: channel.schemaEncoding !== undefined,
    }));
    topics.sort((a, b) => a.name.localeCompare(b.name));
    this.out.toPage({ kind: "topics", topics });
  }

  private tellServices(): void {
    const services = [...this.services.values()].map(({ name, type }) => ({ name, type }));
    services.sort((a, b) => a.name.localeCompare(b.name));
    this.out.toPage({ kind: "services", services });
  }

  private complain(text: string, id?: string): void {
    this.out.toPage({ kind: "status", status: { level: 1, text, ...(id === undefined ? {} : { id }) } });
  }

  private say(message: { op: string; [field: string]: unknown }): void {
    this.out.toServer(JSON.stringify(message));
  }
}

/** Run what may fail because of a definition or a message that others wrote. */
function attempt<T>(run: () => T): T | Error {
  try {
    return run();
  } catch (error) {
    return error instanceof Error ? error : new Error(String(error));
  }
}
