// The binary frames of the Foxglove WebSocket protocol, all integers little-endian.

export type ServerFrame =
  | { op: "message"; subscription: number; time: number; payload: Uint8Array }
  | { op: "time"; time: number }
  | { op: "serviceResponse"; service: number; call: number; payload: Uint8Array }
  | { op: "asset"; request: number; data: Uint8Array }
  | { op: "assetError"; request: number; reason: string };

export class FrameError extends Error {}

const TEXT = new TextDecoder();

export function parseFrame(buffer: ArrayBuffer): ServerFrame {
  const view = new DataView(buffer);
  try {
    switch (view.getUint8(0)) {
      case 1:
        return {
          op: "message",
          subscription: view.getUint32(1, true),
          time: nanosecondsAt(view, 5),
          payload: new Uint8Array(buffer, 13),
        };
      case 2:
        return { op: "time", time: nanosecondsAt(view, 1) };
      case 3: {
        const encoding = view.getUint32(9, true);
        return {
          op: "serviceResponse",
          service: view.getUint32(1, true),
          call: view.getUint32(5, true),
          payload: new Uint8Array(buffer, 13 + encoding),
        };
      }
      case 4: {
        const request = view.getUint32(1, true);
        const reason = view.getUint32(6, true);
        return view.getUint8(5) === 0
          ? { op: "asset", request, data: new Uint8Array(buffer, 10 + reason) }
          : { op: "assetError", request, reason: TEXT.decode(new Uint8Array(buffer, 10, reason)) };
      }
    }
  } catch (error) {
    if (error instanceof RangeError) {
      throw new FrameError(`frame of ${buffer.byteLength} bytes is shorter than it says`);
    }
    throw error;
  }
  throw new FrameError(`unknown opcode ${view.getUint8(0)}`);
}

export function publishFrame(channel: number, payload: Uint8Array): Uint8Array<ArrayBuffer> {
  const frame = new Uint8Array(5 + payload.byteLength);
  const view = new DataView(frame.buffer);
  view.setUint8(0, 1);
  view.setUint32(1, channel, true);
  frame.set(payload, 5);
  return frame;
}

export function serviceRequestFrame(service: number, call: number, payload: Uint8Array): Uint8Array<ArrayBuffer> {
  const encoding = new TextEncoder().encode("cdr");
  const frame = new Uint8Array(13 + encoding.byteLength + payload.byteLength);
  const view = new DataView(frame.buffer);
  view.setUint8(0, 2);
  view.setUint32(1, service, true);
  view.setUint32(5, call, true);
  view.setUint32(9, encoding.byteLength, true);
  frame.set(encoding, 13);
  frame.set(payload, 13 + encoding.byteLength);
  return frame;
}

/** 64-bit nanoseconds as seconds. */
function nanosecondsAt(view: DataView, offset: number): number {
  const [low, high] = [view.getUint32(offset, true), view.getUint32(offset + 4, true)];
  // Whole seconds first: the sum of both would lose the last digits.
  const nanoseconds = (BigInt(high) << 32n) | BigInt(low);
  return Number(nanoseconds / 1_000_000_000n) + Number(nanoseconds % 1_000_000_000n) * 1e-9;
}
