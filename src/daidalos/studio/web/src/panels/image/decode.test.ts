import { describe, expect, it } from "vitest";
import type { Image } from "../../generated/sensor_msgs";
import { ImageError, toRgba } from "./decode";

function image(encoding: string, step: number, data: number[], width = 2, height = 1): Image {
  return {
    header: { stamp: { sec: 0, nanosec: 0 }, frame_id: "" },
    encoding,
    width,
    height,
    step,
    is_bigendian: 0,
    data: new Uint8Array(data),
  };
}

describe("toRgba", () => {
  it.each([
    ["rgb8", 6, [1, 2, 3, 4, 5, 6], [1, 2, 3, 255, 4, 5, 6, 255]],
    ["bgr8", 6, [1, 2, 3, 4, 5, 6], [3, 2, 1, 255, 6, 5, 4, 255]],
    ["rgba8", 8, [1, 2, 3, 4, 5, 6, 7, 8], [1, 2, 3, 255, 5, 6, 7, 255]],
    ["bgra8", 8, [1, 2, 3, 4, 5, 6, 7, 8], [3, 2, 1, 255, 7, 6, 5, 255]],
    ["mono8", 2, [9, 200], [9, 9, 9, 255, 200, 200, 200, 255]],
    ["mono16", 4, [0, 0, 255, 255], [0, 0, 0, 255, 255, 255, 255, 255]],
  ])("reads %s", (encoding, step, data, expected) => {
    expect([...toRgba(image(encoding, step, data))]).toEqual(expected);
  });

  it("leaves the padding of rows out", () => {
    const out = toRgba(image("mono8", 4, [1, 2, 99, 99, 3, 4, 99, 99], 2, 2));
    expect([out[0], out[4], out[8], out[12]]).toEqual([1, 2, 3, 4]);
  });

  it("paints depth where there is some", () => {
    const depth = new Float32Array([Number.NaN, 1, 3]);
    const out = toRgba(image("32FC1", 12, [...new Uint8Array(depth.buffer)], 3));
    expect([...out.slice(0, 4)]).toEqual([0, 0, 0, 255]);
    expect([...out.slice(4, 7)]).not.toEqual([...out.slice(8, 11)]);
  });

  it.each([
    ["yuv422", 4, [0, 0, 0, 0]],
    ["rgb8", 6, [1, 2, 3]],
    ["rgb8", 2, [1, 2, 3, 4, 5, 6]],
  ])("refuses what is no %s image", (encoding, step, data) => {
    expect(() => toRgba(image(encoding, step, data))).toThrow(ImageError);
  });
});
