import { describe, expect, it } from "vitest";
import { FrameError, parseFrame, publishFrame, serviceRequestFrame } from "./frames";

function frame(...parts: (number[] | string)[]): ArrayBuffer {
  const bytes = parts.flatMap((part) => (typeof part === "string" ? [...new TextEncoder().encode(part)] : part));
  return new Uint8Array(bytes).buffer;
}

const u32 = (value: number) => [value & 255, (value >> 8) & 255, (value >> 16) & 255, (value >>> 24) & 255];
const u64 = (value: bigint) => [...u32(Number(value & 0xffffffffn)), ...u32(Number(value >> 32n))];

describe("parseFrame", () => {
  it("reads messages", () => {
    const read = parseFrame(frame([1], u32(4_000_000_000), u64(1_700_000_000_123_456_789n), [9, 8]));
    expect(read).toMatchObject({ op: "message", subscription: 4_000_000_000 });
    if (read.op === "message") {
      expect(read.time).toBeCloseTo(1_700_000_000.123456789, 6);
      expect([...read.payload]).toEqual([9, 8]);
    }
  });

  it("reads time", () => {
    expect(parseFrame(frame([2], u64(2_500_000_000n)))).toEqual({ op: "time", time: 2.5 });
  });

  it("reads service responses after their encoding", () => {
    const read = parseFrame(frame([3], u32(1), u32(2), u32(3), "cdr", [7]));
    expect(read).toMatchObject({ op: "serviceResponse", service: 1, call: 2 });
    expect(read.op === "serviceResponse" && [...read.payload]).toEqual([7]);
  });

  it("reads assets and why there are none", () => {
    const good = parseFrame(frame([4], u32(5), [0], u32(0), [1, 2, 3]));
    expect(good.op === "asset" && [...good.data]).toEqual([1, 2, 3]);
    expect(parseFrame(frame([4], u32(5), [1], u32(4), "gone"))).toEqual({
      op: "assetError",
      request: 5,
      reason: "gone",
    });
  });

  it.each([[[]], [[1, 2]], [[2, 0, 0]], [[4, 0, 0, 0, 0, 1, 255, 255]], [[77]]])("refuses %j", (bytes) => {
    expect(() => parseFrame(new Uint8Array(bytes).buffer)).toThrow(FrameError);
  });
});

it("builds published messages", () => {
  expect([...publishFrame(258, new Uint8Array([1, 2]))]).toEqual([1, 2, 1, 0, 0, 1, 2]);
});

it("builds service requests", () => {
  const expected = [2, ...u32(1), ...u32(2), ...u32(3), 99, 100, 114, 5];
  expect([...serviceRequestFrame(1, 2, new Uint8Array([5]))]).toEqual(expected);
});
