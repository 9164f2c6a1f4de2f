import { expect, it } from "vitest";
import { ellipseOf } from "./pose_with_covariance";

it("finds the axes of a covariance", () => {
  const yaw = 0.6;
  const [major, minor] = [0.5, 0.2];
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const xx = c * c * major ** 2 + s * s * minor ** 2;
  const yy = s * s * major ** 2 + c * c * minor ** 2;
  const xy = c * s * (major ** 2 - minor ** 2);
  const found = ellipseOf(xx, xy, yy);
  expect(found.yaw).toBeCloseTo(yaw);
  expect(found.major).toBeCloseTo(major);
  expect(found.minor).toBeCloseTo(minor);
});

it("takes covariances that are none for points", () => {
  expect(ellipseOf(0, 0, 0)).toEqual({ yaw: 0, major: 0, minor: 0 });
  expect(ellipseOf(-1, 0, -1).major).toBe(0);
});
