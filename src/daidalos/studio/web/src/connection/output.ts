// Where the worker sends frames and messages to.
import type { ClientMessage } from "../generated/protocol";
import type { FromWorker } from "./boundary";

export interface Output {
  toServer(frame: string | Uint8Array<ArrayBuffer>): void;
  toPage(message: FromWorker, transfer?: Transferable[]): void;
}

/** Send a JSON message of the protocol. */
export function toServer(out: Output, message: ClientMessage): void {
  out.toServer(JSON.stringify(message));
}
