import { BoxGeometry, CylinderGeometry, SphereGeometry, type BufferGeometry } from "three";
import { describe, expect, it } from "vitest";
import { wrapBox, wrapRound } from "./wrapping";

/** Corners with their place in the image. */
function corners({ attributes: { position, normal, uv } }: BufferGeometry) {
  return Array.from({ length: position?.count ?? 0 }, (_, i) => ({
    at: [position?.getX(i), position?.getY(i), position?.getZ(i)] as [number, number, number],
    normal: [normal?.getX(i), normal?.getY(i), normal?.getZ(i)] as [number, number, number],
    u: uv?.getX(i) as number,
    v: uv?.getY(i) as number,
  }));
}

describe("images", () => {
  it("stand upright on the sides of a box, seen from outside", () => {
    const box = new BoxGeometry();
    wrapBox(box);
    for (const { at, normal, u, v } of corners(box)) {
      if (normal[2] === 0) {
        // To the right of who looks at a side is its normal turned a quarter about z.
        const right = [-normal[1], normal[0]] as const;
        expect([u, v]).toEqual([0.5 + right[0] * at[0] + right[1] * at[1], 0.5 + at[2]]);
      } else {
        expect([u, v]).toEqual([0.5 + normal[2] * at[0], 0.5 + at[1]]);
      }
    }
  });

  it.each([
    ["a cylinder", new CylinderGeometry(0.5, 0.5, 1, 12)],
    ["a sphere", new SphereGeometry(0.5, 12, 8)],
  ])("go once around %s, counted from behind", (_, geometry) => {
    geometry.rotateX(Math.PI / 2);
    wrapRound(geometry);
    for (const { at, normal, u, v } of corners(geometry)) {
      const isLid = geometry.type === "CylinderGeometry" && Math.abs(normal[2]) > 0.9;
      if (!isLid && Math.hypot(at[0], at[1]) > 1e-6) {
        const turn = Math.atan2(at[1], at[0]) / (2 * Math.PI) + 0.5;
        expect(Math.cos(2 * Math.PI * (u - turn))).toBeCloseTo(1, 6);
        expect(v).toBeCloseTo(0.5 + at[2], 6);
      }
    }
  });
});
