// Where the worker's conversation with the server goes.
import type { FromWorker } from "./boundary";

export interface Output {
  toServer(frame: string | Uint8Array<ArrayBuffer>): void;
  toPage(message: FromWorker, transfer?: Transferable[]): void;
}
