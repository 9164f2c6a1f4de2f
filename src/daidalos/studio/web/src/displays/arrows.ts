// Arrows at poses, and what the displays of poses have in common.
import {
  DynamicDrawUsage,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  Quaternion,
  Vector3,
  type BufferGeometry,
} from "three";
import type { Pose, PoseArray, PoseStamped, PoseWithCovarianceStamped } from "../generated/geometry_msgs";
import type { Odometry } from "../generated/nav_msgs";
import { arrowGeometry } from "../scene/shapes";
import type { Property, Settings } from "../contract";
import type { DisplayContext } from "./display";
import { number, text } from "./settings";
import { StampedDisplay } from "./topic_display";

export const ARROW_PROPERTIES: readonly Property[] = [
  { key: "color", label: "Colour", kind: "color" },
  { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  { key: "length", label: "Length", kind: "number", min: 0.01, max: 20, step: 0.05, unit: "m" },
];

/** An arrow of a length, in pleasing proportions. */
export function poseArrow(length: number): BufferGeometry {
  return arrowGeometry({
    shaftLength: length * 0.72,
    shaftRadius: length * 0.045,
    headLength: length * 0.28,
    headRadius: length * 0.115,
  });
}

/** Arrows at many poses in one draw call. */
class Arrows extends InstancedMesh<BufferGeometry, MeshStandardMaterial> {
  constructor(capacity: number, length: number) {
    super(poseArrow(length), new MeshStandardMaterial({ roughness: 0.7 }), capacity);
    this.instanceMatrix.setUsage(DynamicDrawUsage);
    this.frustumCulled = false;
    this.count = 0;
  }

  paint(color: string, alpha: number): void {
    this.material.color.set(color);
    this.material.opacity = alpha;
    this.material.transparent = alpha < 1;
  }

  setPoses(poses: readonly Pose[]): void {
    this.count = Math.min(poses.length, this.instanceMatrix.count);
    for (let i = 0; i < this.count; i++) {
      const { position, orientation } = poses[i] as Pose;
      POSITION.set(position.x, position.y, position.z);
      ROTATION.set(orientation.x, orientation.y, orientation.z, orientation.w).normalize();
      this.setMatrixAt(i, MATRIX.compose(POSITION, ROTATION, ONE));
    }
    this.instanceMatrix.needsUpdate = true;
  }
}

const POSITION = new Vector3();
const ROTATION = new Quaternion();
const ONE = new Vector3(1, 1, 1);
const MATRIX = new Matrix4();

export abstract class ArrowsDisplay<
  M extends PoseStamped | PoseWithCovarianceStamped | PoseArray | Odometry,
> extends StampedDisplay<M> {
  private arrows = new Arrows(1, 1);
  private length = 0;

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings, "latest");
  }

  protected abstract posesOf(message: M): readonly Pose[];

  protected override show(message: M): void {
    const poses = this.posesOf(message);
    const length = number(this.settings, "length");
    if (length !== this.length || poses.length > this.arrows.instanceMatrix.count) {
      this.length = length;
      this.arrows.geometry.dispose();
      this.arrows.removeFromParent();
      this.arrows = new Arrows(Math.ceil(poses.length * 1.25), length);
      this.object.add(this.arrows);
    }
    this.arrows.paint(text(this.settings, "color"), number(this.settings, "alpha"));
    this.arrows.setPoses(poses);
  }
}
