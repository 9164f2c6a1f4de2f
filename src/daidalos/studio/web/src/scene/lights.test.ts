import { DirectionalLight } from "three";
import { describe, expect, it } from "vitest";
import { Lights } from "./lights";

function radiusFrom(lights: Lights, distance: number): number {
  lights.follow({ x: 3, y: 4 }, distance);
  const sun = lights.object.children.find((each) => each instanceof DirectionalLight && each.castShadow);
  const { camera } = (sun as DirectionalLight).shadow;
  expect([camera.left, camera.top]).toEqual([-camera.right, camera.right]);
  return camera.right;
}

describe("the shadow", () => {
  it("is as wide as may be seen, within limits", () => {
    const lights = new Lights();
    const near = radiusFrom(lights, 0);
    expect(near).toBe(2.5);
    expect(radiusFrom(lights, 2)).toBe(near);
    expect(radiusFrom(lights, 10)).toBeGreaterThan(6);
    expect(radiusFrom(lights, 1000)).toBeLessThan(20);
  });

  it("does not creep while one comes closer", () => {
    const lights = new Lights();
    expect(radiusFrom(lights, 10)).toBe(radiusFrom(lights, 10.3));
  });

  it("is drawn anew when bodies or what is followed have moved, not when the camera has", () => {
    const lights = new Lights();
    lights.shadows = "soft";
    const { shadow } = lights.object.children.find(
      (each) => each instanceof DirectionalLight && each.castShadow,
    ) as DirectionalLight;
    const isDrawnAnew = (change: () => void): boolean => {
      shadow.needsUpdate = false;
      change();
      return shadow.needsUpdate;
    };
    lights.follow({ x: 1, y: 2 }, 3);
    expect(shadow.autoUpdate).toBe(false);
    expect(isDrawnAnew(() => lights.follow({ x: 1, y: 2 }, 3))).toBe(false);
    expect(isDrawnAnew(() => lights.follow({ x: 1.5, y: 2 }, 3))).toBe(true);
    expect(isDrawnAnew(() => lights.follow({ x: 1.5, y: 2 }, 30))).toBe(true);
    expect(isDrawnAnew(() => lights.refresh())).toBe(true);
    lights.shadows = "flat";
    expect(lights.object.children.some((each) => each.castShadow)).toBe(false);
    expect(lights.flat.on).toBe(true);
  });
});
