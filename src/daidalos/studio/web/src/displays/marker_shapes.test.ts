import { Box3, Mesh, Vector3 } from "three";
import { describe, expect, it } from "vitest";
import type { Vector3 as Point } from "../generated/geometry_msgs";
import { Marker } from "../generated/visualization_msgs";
import type { Assets } from "../scene/assets";
import { markerObject } from "./marker_shapes";

const CONTEXT = {
  assets: {} as Assets,
  dark: true,
  changed: () => undefined,
  onError: (text: string) => {
    throw new Error(text);
  },
};

function marker(type: number, scale: Point, points: Point[] = []): Marker {
  const pose = { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  const header = { stamp: { sec: 0, nanosec: 0 }, frame_id: "" };
  return { header, type, scale, points, pose, colors: [], color: { r: 1, g: 1, b: 1, a: 1 } } as unknown as Marker;
}

const SIZE = { x: 1, y: 2, z: 3 };
const CORNERS = [
  { x: 0, y: 0, z: 0 },
  { x: 1, y: 0, z: 0 },
  { x: 1, y: 2, z: 3 },
];

describe("what is solid", () => {
  it.each([
    ["a cube", marker(Marker.CUBE, SIZE)],
    ["a sphere", marker(Marker.SPHERE, SIZE)],
    ["a cylinder", marker(Marker.CYLINDER, SIZE)],
    ["triangles", marker(Marker.TRIANGLE_LIST, { x: 1, y: 1, z: 1 }, CORNERS)],
  ])("is as large as it is told, and can be taken: %s", (_, told) => {
    const object = markerObject(told, CONTEXT) as Mesh;
    const size = new Box3().setFromObject(object).getSize(new Vector3());
    expect(size.toArray().map((length) => Number(length.toFixed(2)))).toEqual([1, 2, 3]);
    expect(object.userData.pickable).toBe(true);
  });
});

describe("points with colors of their own", () => {
  it.each([Marker.LINE_LIST, Marker.LINE_STRIP, Marker.SPHERE_LIST, Marker.CUBE_LIST])(
    "are visible where the marker has no color: type %s",
    (type) => {
      const told = marker(type, SIZE, CORNERS);
      const colors = CORNERS.map(() => ({ r: 1, g: 0, b: 0, a: 0.5 }));
      const object = markerObject({ ...told, colors, color: { r: 0, g: 0, b: 0, a: 0 } }, CONTEXT) as Mesh;
      expect((object.material as { opacity: number }).opacity).toBe(0.5);
    },
  );
});
