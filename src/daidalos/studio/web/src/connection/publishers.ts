// The page's publishers: each topic is advertised once, messages are sent as CDR.
import { DEFINITIONS } from "../generated/definitions";
import { ENCODING, SCHEMA_ENCODING } from "../generated/protocol";
import { attempt, makeWriter, type Writer } from "./codecs";
import { publishFrame } from "./frames";
import { type Output, toServer } from "./output";

interface Publisher {
  number: number;
  write: Writer;
}

export interface PublisherContext {
  /** Return a number that no other channel or subscription of the page has. */
  number(): number;
  /** The definition of a type, where a channel of the server's carries it. */
  definitionOf(type: string): string | undefined;
}

export class Publishers {
  private readonly publishers = new Map<string, Publisher>();

  constructor(
    private readonly out: Output,
    private readonly around: PublisherContext,
  ) {}

  reset(): void {
    this.publishers.clear();
  }

  publish(topic: string, type: string, message: unknown): void {
    const done = attempt(() => {
      const { number, write } = this.publisherFor(topic, type);
      this.out.toServer(publishFrame(number, write(message)));
    });
    this.out.toPage({ kind: "published", topic, ...(done instanceof Error ? { error: done.message } : {}) });
  }

  private publisherFor(topic: string, type: string): Publisher {
    const key = `${topic} ${type}`;
    const known = this.publishers.get(key);
    if (known) {
      return known;
    }
    const schema = this.around.definitionOf(type) ?? DEFINITIONS[type];
    if (schema === undefined) {
      throw new Error(`the definition of ${type} is not known here`);
    }
    const publisher = { number: this.around.number(), write: makeWriter(schema) };
    this.publishers.set(key, publisher);
    const channel = {
      id: publisher.number,
      topic,
      encoding: ENCODING,
      schemaName: type,
      schema,
      schemaEncoding: SCHEMA_ENCODING,
    };
    toServer(this.out, { op: "advertise", channels: [channel] });
    return publisher;
  }
}
