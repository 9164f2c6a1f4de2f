// A camera of the scene that sees as a real one does, by its calibration.
import { Matrix4, PerspectiveCamera, Quaternion } from "three";
import type { CameraInfo } from "../generated/sensor_msgs";
import type { Transform } from "../tf/buffer";

const NEAR_M = 0.02;
const FAR_M = 500;
/** From three.js' axes (y up, looking along -z) to those of an optical frame (y down, looking along z). */
const OPTICAL = new Quaternion(1, 0, 0, 0);

/** Whether a calibration has what is needed: an uncalibrated camera has zeros. */
export function isCalibrated({ p, k }: CameraInfo): boolean {
  return (p[0] ?? 0) > 0 || (k[0] ?? 0) > 0;
}

/** Set a camera to a calibration and to the pose of its optical frame. */
export function setLens(camera: PerspectiveCamera, { width, height, p, k }: CameraInfo, pose: Transform): void {
  const [fx, cx, fy, cy] = (p[0] ?? 0) > 0 ? [p[0], p[2], p[5], p[6]] : [k[0], k[2], k[4], k[5]];
  const across = (pixels: number) => (NEAR_M * pixels) / (fx as number);
  const upwards = (pixels: number) => (NEAR_M * pixels) / (fy as number);
  camera.projectionMatrix = new Matrix4().makePerspective(
    across(-(cx as number)),
    across(width - (cx as number)),
    upwards(cy as number),
    upwards((cy as number) - height),
    NEAR_M,
    FAR_M,
  );
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  camera.position.copy(pose.position);
  camera.quaternion.copy(pose.rotation).multiply(OPTICAL);
  camera.updateMatrixWorld();
}
