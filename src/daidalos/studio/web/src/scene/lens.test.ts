import { PerspectiveCamera, Quaternion, Vector3 } from "three";
import { expect, it } from "vitest";
import type { CameraInfo } from "../generated/sensor_msgs";
import { Transform } from "../tf/buffer";
import { isCalibrated, setLens } from "./lens";

const K = [500, 0, 300, 0, 510, 250, 0, 0, 1];
const P = [500, 0, 300, 0, 0, 510, 250, 0, 0, 0, 1, 0];
const info = (p: number[]) =>
  ({ width: 640, height: 480, k: Float64Array.from(K), p: Float64Array.from(p) }) as unknown as CameraInfo;

it.each([
  ["its projection", P],
  ["its matrix, where it has no projection", Array(12).fill(0)],
])("sees a point in the pixel that the calibration tells, by %s", (_, p) => {
  const pose = new Transform();
  pose.position.set(1, 2, 3);
  pose.rotation.copy(new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), 0.3));
  const camera = new PerspectiveCamera();
  setLens(camera, info(p), pose);
  const inCamera = new Vector3(0.2, -0.1, 2);
  const at = inCamera.clone().applyQuaternion(pose.rotation).add(pose.position).project(camera);
  expect(((at.x + 1) / 2) * 640).toBeCloseTo((500 * 0.2) / 2 + 300);
  expect(((1 - at.y) / 2) * 480).toBeCloseTo((510 * -0.1) / 2 + 250);
});

it("knows a camera that was not calibrated", () => {
  expect(isCalibrated(info(P))).toBe(true);
  expect(isCalibrated({ ...info(P), k: new Float64Array(9), p: new Float64Array(12) } as CameraInfo)).toBe(false);
});
