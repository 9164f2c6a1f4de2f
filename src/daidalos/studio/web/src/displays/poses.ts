// Pose, PoseWithCovariance and PoseArray: arrows.
import {
  CircleGeometry,
  DynamicDrawUsage,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Quaternion,
  Vector3,
  type BufferGeometry,
} from "three";
import type { Pose, PoseArray, PoseStamped, PoseWithCovarianceStamped } from "../generated/geometry_msgs";
import { Layer } from "../scene/layers";
import { arrowGeometry } from "../scene/shapes";
import type { DisplayContext, DisplayType } from "./display";
import { flag, number, text, type Property, type Settings } from "./settings";
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
export class Arrows extends InstancedMesh<BufferGeometry, MeshStandardMaterial> {
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

abstract class ArrowsDisplay<M extends PoseStamped | PoseWithCovarianceStamped | PoseArray> extends StampedDisplay<M> {
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

class PoseDisplay extends ArrowsDisplay<PoseStamped> {
  protected override posesOf({ pose }: PoseStamped): readonly Pose[] {
    return [pose];
  }
}

class PoseArrayDisplay extends ArrowsDisplay<PoseArray> {
  protected override posesOf({ poses }: PoseArray): readonly Pose[] {
    return poses;
  }

  protected override describe({ poses }: PoseArray): string {
    return `${poses.length} poses`;
  }
}

class PoseWithCovarianceDisplay extends ArrowsDisplay<PoseWithCovarianceStamped> {
  private readonly ellipse = new Mesh(
    new CircleGeometry(1, 48),
    new MeshBasicMaterial({ transparent: true, depthWrite: false }),
  );

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings);
    this.ellipse.renderOrder = Layer.SHADOW;
    this.object.add(this.ellipse);
  }

  protected override posesOf({ pose }: PoseWithCovarianceStamped): readonly Pose[] {
    return [pose.pose];
  }

  protected override show(message: PoseWithCovarianceStamped): void {
    super.show(message);
    const { pose, covariance } = message.pose;
    const { yaw, major, minor } = ellipseOf(covariance[0] ?? 0, covariance[1] ?? 0, covariance[7] ?? 0);
    this.ellipse.visible = flag(this.settings, "covariance") && major > 0;
    this.ellipse.position.set(pose.position.x, pose.position.y, pose.position.z + 0.01);
    this.ellipse.rotation.set(0, 0, yaw);
    this.ellipse.scale.set(Math.max(major, 1e-4), Math.max(minor, 1e-4), 1);
    this.ellipse.material.color.set(text(this.settings, "color"));
    this.ellipse.material.opacity = 0.22 * number(this.settings, "alpha");
  }
}

/** Half axes (one standard deviation) and direction of a covariance in the plane. */
export function ellipseOf(xx: number, xy: number, yy: number): { yaw: number; major: number; minor: number } {
  const mean = (xx + yy) / 2;
  const spread = Math.hypot((xx - yy) / 2, xy);
  return {
    yaw: 0.5 * Math.atan2(2 * xy, xx - yy),
    major: Math.sqrt(Math.max(0, mean + spread)),
    minor: Math.sqrt(Math.max(0, mean - spread)),
  };
}

export const POSE: DisplayType = {
  type: "Pose",
  messages: ["geometry_msgs/msg/PoseStamped"],
  properties: [{ key: "topic", label: "Topic", kind: "topic" }, ...ARROW_PROPERTIES],
  defaults: { topic: "/goal_pose", color: "#f472b6", alpha: 1, length: 0.5 },
  create: (context, settings) => new PoseDisplay(context, settings),
};

export const POSE_WITH_COVARIANCE: DisplayType = {
  type: "PoseWithCovariance",
  messages: ["geometry_msgs/msg/PoseWithCovarianceStamped"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    ...ARROW_PROPERTIES,
    { key: "covariance", label: "Covariance", kind: "toggle" },
  ],
  defaults: { topic: "", color: "#a78bfa", alpha: 1, length: 0.5, covariance: true },
  create: (context, settings) => new PoseWithCovarianceDisplay(context, settings),
};

export const POSE_ARRAY: DisplayType = {
  type: "PoseArray",
  messages: ["geometry_msgs/msg/PoseArray"],
  properties: [{ key: "topic", label: "Topic", kind: "topic" }, ...ARROW_PROPERTIES],
  defaults: { topic: "", color: "#60a5fa", alpha: 0.9, length: 0.15 },
  create: (context, settings) => new PoseArrayDisplay(context, settings),
};
