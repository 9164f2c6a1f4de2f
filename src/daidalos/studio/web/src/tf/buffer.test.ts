import { Quaternion, Vector3 } from "three";
import { beforeEach, describe, expect, it } from "vitest";
import type { TransformStamped } from "../generated/geometry_msgs";
import { toStamp } from "../ros/time";
import { Transform, TransformBuffer } from "./buffer";

function transform(parent: string, child: string, time: number, x: number, yaw = 0): TransformStamped {
  return {
    header: { stamp: toStamp(time), frame_id: parent },
    child_frame_id: child,
    transform: {
      translation: { x, y: 0, z: 0 },
      rotation: { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) },
    },
  };
}

let buffer: TransformBuffer;
const out = new Transform();

beforeEach(() => {
  buffer = new TransformBuffer();
});

describe("lookup", () => {
  it("walks up, down and across the tree", () => {
    buffer.set(transform("map", "odom", 1, 1, Math.PI / 2), false);
    buffer.set(transform("odom", "base", 1, 2), false);
    buffer.set(transform("base", "laser", 0, 0.5), true);
    buffer.set(transform("map", "dock", 0, 5), true);
    expect(buffer.lookup("map", "laser", 1, out)).toBe(true);
    expect(out.position.x).toBeCloseTo(1);
    expect(out.position.y).toBeCloseTo(2.5);
    expect(out.yaw).toBeCloseTo(Math.PI / 2);
    expect(buffer.lookup("laser", "map", 1, out)).toBe(true);
    expect(out.position.x).toBeCloseTo(-2.5);
    expect(out.position.y).toBeCloseTo(1);
    expect(buffer.lookup("dock", "base", 1, out)).toBe(true);
    expect(out.position.x).toBeCloseTo(-4);
    expect(out.position.y).toBeCloseTo(2);
  });

  it("agrees with its inverse for any tree of random transforms", () => {
    let seed = 7;
    const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
    for (let i = 1; i < 30; i++) {
      const rotation = new Quaternion(random(), random(), random(), random()).normalize();
      buffer.set(
        {
          header: { stamp: toStamp(1), frame_id: `f${Math.floor((random() + 0.5) * i)}` },
          child_frame_id: `f${i}`,
          transform: { translation: { x: random(), y: random(), z: random() }, rotation },
        },
        false,
      );
    }
    const back = new Transform();
    for (const [a, b] of [
      ["f3", "f29"],
      ["f0", "f17"],
      ["f11", "f28"],
    ] as const) {
      expect(buffer.lookup(a, b, 1, out)).toBe(true);
      expect(buffer.lookup(b, a, 1, back)).toBe(true);
      back.premultiply(out);
      expect(back.position.length()).toBeLessThan(1e-12);
      expect(back.rotation.angleTo(new Quaternion())).toBeLessThan(1e-6);
    }
  });

  it("interpolates between samples, rotations along the shorter way", () => {
    buffer.set(transform("odom", "base", 10, 0, (170 * Math.PI) / 180), false);
    buffer.set(transform("odom", "base", 11, 1, (-170 * Math.PI) / 180), false);
    expect(buffer.lookup("odom", "base", 10.5, out)).toBe(true);
    expect(out.position.x).toBeCloseTo(0.5);
    expect(Math.abs(out.yaw)).toBeCloseTo(Math.PI);
  });

  it("does not extrapolate unless told to clamp", () => {
    buffer.set(transform("odom", "base", 10, 1), false);
    buffer.set(transform("odom", "base", 11, 2), false);
    for (const [time, x] of [
      [9, 1],
      [12, 2],
    ] as const) {
      expect(buffer.lookup("odom", "base", time, out)).toBe(false);
      expect(buffer.lookup("odom", "base", time, out, { clamp: true })).toBe(true);
      expect(out.position.x).toBe(x);
    }
    expect(buffer.lookup("odom", "base", "latest", out)).toBe(true);
    expect(out.position.x).toBe(2);
  });

  it("takes samples that arrive out of order and replaces those of the same time", () => {
    for (const [time, x] of [
      [1, 1],
      [3, 3],
      [2, 2],
      [3, 3.5],
    ] as const) {
      buffer.set(transform("odom", "base", time, x), false);
    }
    expect(buffer.lookup("odom", "base", 2.5, out)).toBe(true);
    expect(out.position.x).toBeCloseTo(2.75);
  });

  it("says why it fails", () => {
    buffer.set(transform("map", "odom", 1, 0), false);
    buffer.set(transform("other", "thing", 1, 0), false);
    expect(buffer.lookup("map", "nowhere", 1, out)).toBe(false);
    expect(buffer.explain("map", "nowhere", 1)).toBe("frame nowhere does not exist");
    expect(buffer.lookup("map", "thing", 1, out)).toBe(false);
    expect(buffer.explain("map", "thing", 1)).toBe("thing and map are not connected");
    expect(buffer.explain("map", "odom", 9)).toBe("no transform from odom to map at this time");
  });
});

describe("the tree", () => {
  it("knows its frames, roots and main root", () => {
    buffer.set(transform("map", "odom", 1, 0), false);
    buffer.set(transform("odom", "base", 1, 0), false);
    buffer.set(transform("world", "camera", 1, 0), true);
    expect(buffer.frames().sort()).toEqual(["base", "camera", "map", "odom", "world"]);
    expect(buffer.rootOf("base")).toBe("map");
    expect(buffer.mainRoot()).toBe("map");
  });

  it("counts its changes, but not new samples", () => {
    buffer.set(transform("map", "odom", 1, 0), false);
    const before = buffer.structure;
    buffer.set(transform("map", "odom", 2, 0), false);
    expect(buffer.structure).toBe(before);
    buffer.set(transform("world", "odom", 3, 0), false);
    expect(buffer.structure).not.toBe(before);
    expect(buffer.rootOf("odom")).toBe("world");
  });

  it("survives loops and frames that are their own parents", () => {
    buffer.set(transform("a", "b", 1, 0), false);
    buffer.set(transform("b", "a", 1, 0), false);
    buffer.set(transform("c", "c", 1, 0), false);
    expect(buffer.lookup("a", "nowhere", 1, out)).toBe(false);
    expect(buffer.rootOf("a")).toBeTypeOf("string");
  });

  it("takes ROS 1's leading slashes off", () => {
    buffer.set(transform("/map", "/odom", 1, 2), false);
    expect(buffer.lookup("map", "odom", "latest", out)).toBe(true);
  });

  it("forgets what is older than ten seconds and stays right", () => {
    for (let i = 0; i <= 3000; i++) {
      buffer.set(transform("odom", "base", i / 100, i), false);
    }
    expect(buffer.lookup("odom", "base", 5, out)).toBe(false);
    expect(buffer.lookup("odom", "base", 21.005, out)).toBe(true);
    expect(out.position.x).toBeCloseTo(2100.5);
  });

  it("starts anew when time is turned back", () => {
    let resets = 0;
    buffer.onReset = () => resets++;
    buffer.set(transform("odom", "base", 100, 1), false);
    buffer.set(transform("base", "laser", 100, 1), true);
    buffer.set(transform("odom", "base", 1, 2), false);
    expect(resets).toBe(1);
    expect(buffer.lookup("odom", "laser", 1, out)).toBe(true);
    expect(out.position.x).toBe(3);
  });
});

it("transforms compose like their matrices", () => {
  const outer = new Transform();
  outer.position.set(1, 2, 3);
  outer.rotation.setFromAxisAngle(new Vector3(0, 0, 1), 0.7);
  const inner = new Transform();
  inner.position.set(-1, 0.5, 0);
  inner.rotation.setFromAxisAngle(new Vector3(1, 0, 0), -0.3);
  const point = new Vector3(0.2, 0.4, 0.8);
  const expected = point.clone().applyQuaternion(inner.rotation).add(inner.position);
  expected.applyQuaternion(outer.rotation).add(outer.position);
  inner.premultiply(outer);
  expect(point.applyQuaternion(inner.rotation).add(inner.position).distanceTo(expected)).toBeLessThan(1e-12);
});
