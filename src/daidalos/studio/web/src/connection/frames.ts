// The binary frames of the Foxglove WebSocket protocol, all integers little-endian.
import { ASSET, ENCODING, MESSAGE, PUBLISH, SERVICE_REQUEST, SERVICE_RESPONSE, TIME } from "../generated/protocol";

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
      case MESSAGE.opcode:
        return {
          op: "message",
          subscription: view.getUint32(MESSAGE.subscription, true),
          time: nanosecondsAt(view, MESSAGE.time),
          payload: new Uint8Array(buffer, MESSAGE.size),
        };
      case TIME.opcode:
        return { op: "time", time: nanosecondsAt(view, TIME.time) };
      case SERVICE_RESPONSE.opcode: {
        const encoding = view.getUint32(SERVICE_RESPONSE.length, true);
        return {
          op: "serviceResponse",
          service: view.getUint32(SERVICE_RESPONSE.service, true),
          call: view.getUint32(SERVICE_RESPONSE.call, true),
          payload: new Uint8Array(buffer, SERVICE_RESPONSE.size + encoding),
        };
      }
      case ASSET.opcode: {
        const request = view.getUint32(ASSET.request, true);
        const reason = view.getUint32(ASSET.length, true);
        return view.getUint8(ASSET.status) === 0
          ? { op: "asset", request, data: new Uint8Array(buffer, ASSET.size + reason) }
          : { op: "assetError", request, reason: TEXT.decode(new Uint8Array(buffer, ASSET.size, reason)) };
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
  const frame = new Uint8Array(PUBLISH.size + payload.byteLength);
  const view = new DataView(frame.buffer);
  view.setUint8(0, PUBLISH.opcode);
  view.setUint32(PUBLISH.channel, channel, true);
  frame.set(payload, PUBLISH.size);
  return frame;
}

export function serviceRequestFrame(service: number, call: number, payload: Uint8Array): Uint8Array<ArrayBuffer> {
  const encoding = new TextEncoder().encode(ENCODING);
  const frame = new Uint8Array(SERVICE_REQUEST.size + encoding.byteLength + payload.byteLength);
  const view = new DataView(frame.buffer);
  view.setUint8(0, SERVICE_REQUEST.opcode);
  view.setUint32(SERVICE_REQUEST.service, service, true);
  view.setUint32(SERVICE_REQUEST.call, call, true);
  view.setUint32(SERVICE_REQUEST.length, encoding.byteLength, true);
  frame.set(encoding, SERVICE_REQUEST.size);
  frame.set(payload, SERVICE_REQUEST.size + encoding.byteLength);
  return frame;
}

/** 64-bit nanoseconds as seconds. */
function nanosecondsAt(view: DataView, offset: number): number {
  const [low, high] = [view.getUint32(offset, true), view.getUint32(offset + 4, true)];
  // Whole seconds first: the sum of both would lose the last digits.
  const nanoseconds = (BigInt(high) << 32n) | BigInt(low);
  return Number(nanoseconds / 1_000_000_000n) + Number(nanoseconds % 1_000_000_000n) * 1e-9;
}
