// How an image lies on shapes of unit size: as the simulator's cameras see it.
import type { BufferGeometry } from "three";

/** Around the z axis this much of a turn lies between where three.js begins with an image and where it is to begin. */
const CYLINDER_START = 0.25;
const LID = 0.9;

/** Each side of a box shows the whole image: upright, seen from outside; from above what points up or down. */
export function wrapBox(geometry: BufferGeometry): void {
  const [position, normal, uv] = attributesOf(geometry);
  for (let i = 0; i < position.count; i++) {
    const [x, y, z] = [position.getX(i) + 0.5, position.getY(i) + 0.5, position.getZ(i) + 0.5];
    const [nx, ny] = [normal.getX(i), normal.getY(i)];
    if (Math.abs(nx) > 0.5) {
      uv.setXY(i, nx > 0 ? y : 1 - y, z);
    } else if (Math.abs(ny) > 0.5) {
      uv.setXY(i, ny > 0 ? 1 - x : x, z);
    } else {
      uv.setXY(i, normal.getZ(i) > 0 ? x : 1 - x, y);
    }
  }
}

/** A sphere or a cylinder, both with z upwards, has the image once around it; a lid shows the whole of it. */
export function wrapRound(geometry: BufferGeometry): void {
  const [position, normal, uv] = attributesOf(geometry);
  const isSphere = geometry.type === "SphereGeometry";
  for (let i = 0; i < position.count; i++) {
    const [x, y, z] = [position.getX(i) + 0.5, position.getY(i) + 0.5, position.getZ(i) + 0.5];
    if (!isSphere && Math.abs(normal.getZ(i)) > LID) {
      uv.setXY(i, normal.getZ(i) > 0 ? x : 1 - x, y);
    } else {
      uv.setXY(i, uv.getX(i) + (isSphere ? 0 : CYLINDER_START), z);
    }
  }
}

function attributesOf(geometry: BufferGeometry) {
  return [geometry.getAttribute("position"), geometry.getAttribute("normal"), geometry.getAttribute("uv")] as const;
}
