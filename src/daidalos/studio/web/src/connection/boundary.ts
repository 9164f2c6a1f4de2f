// The messages between the page and its worker.
import type { ServiceInfo, TopicInfo } from "../contract";
import type { ParameterEntry } from "../generated/protocol";

/** Publishers, subscribers and servers: names of nodes by topic or service. */
export interface ConnectionGraph {
  publishers: ReadonlyMap<string, readonly string[]>;
  subscribers: ReadonlyMap<string, readonly string[]>;
  services: ReadonlyMap<string, readonly string[]>;
}

export interface Received {
  topic: string;
  /** When it arrived in the graph, in seconds of the graph's clock. */
  time: number;
  message: unknown;
}

/** Robot time at an instant, by the server's clock, otherwise by the newest message. */
export interface ClockReading {
  robot: number;
  /** Milliseconds since the epoch, by this machine's steady clock: worker and page count from different zeros. */
  at: number;
  announced: boolean;
}

export interface Traffic {
  /** Messages and bytes per second; undefined until they were measured over a whole window. */
  rate: number | undefined;
  bandwidth: number | undefined;
  total: number;
}

export interface StatusInfo {
  level: number;
  text: string;
  id?: string;
}

export type LinkState = "connecting" | "connected" | "silent" | "lost";

export type ToWorker =
  | { kind: "open"; url: string }
  | { kind: "ready" }
  /** Whether the page is visible: a hidden one gets longer batches. */
  | { kind: "visible"; visible: boolean }
  /** Also to change how many messages of a topic are kept; with 0 they are only counted. */
  | { kind: "subscribe"; topic: string; keep: number }
  | { kind: "unsubscribe"; topic: string }
  | { kind: "publish"; topic: string; type: string; message: unknown }
  | { kind: "call"; id: number; service: string; request: unknown }
  /** Get an empty request of a service, or an empty message of a topic. */
  | { kind: "template"; id: number; of: "service" | "topic"; name: string }
  | { kind: "fetchAsset"; id: number; uri: string }
  | { kind: "getParameters"; names: string[] }
  | { kind: "setParameters"; parameters: readonly ParameterEntry[] }
  | { kind: "watchGraph"; on: boolean };

export type FromWorker =
  | { kind: "link"; state: LinkState; reason?: string }
  | { kind: "server"; name: string; session: string; hasTime: boolean }
  | { kind: "topics"; topics: TopicInfo[] }
  | { kind: "services"; services: ServiceInfo[] }
  | { kind: "batch"; messages: Received[]; clock?: ClockReading }
  | { kind: "traffic"; traffic: Record<string, Traffic> }
  | { kind: "status"; status: StatusInfo }
  | { kind: "removeStatus"; ids: readonly string[] }
  | { kind: "published"; topic: string; error?: string }
  | { kind: "response"; id: number; message?: unknown; error?: string }
  | { kind: "asset"; id: number; data?: ArrayBuffer; error?: string }
  | { kind: "parameters"; parameters: readonly ParameterEntry[] }
  | { kind: "graph"; graph: ConnectionGraph };
