// Readers and writers of CDR, made from message definitions when they are first used.
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";

export type Reader = (payload: Uint8Array) => unknown;
export type Writer = (message: unknown) => Uint8Array;

export function makeReader(definition: string): Reader {
  const reader = new MessageReader(parse(definition, { ros2: true }));
  return (payload) => reader.readMessage(payload);
}

export function makeWriter(definition: string): Writer {
  const writer = new MessageWriter(parse(definition, { ros2: true }));
  return (message) => writer.writeMessage(message);
}

/** A message with the defaults of its definition. */
export function emptyMessage(definition: string): unknown {
  return makeReader(definition)(makeWriter(definition)({}));
}

/** Run what may fail because of a definition or message from elsewhere; returns the error. */
export function attempt<T>(run: () => T): T | Error {
  try {
    return run();
  } catch (error) {
    return error instanceof Error ? error : new Error(String(error));
  }
}
