// 2D Goal Pose and 2D Pose Estimate: press where, drag to where it looks, release.
import { Group, Mesh, MeshBasicMaterial, RingGeometry, type Vector3 } from "three";
import { poseArrow } from "../displays/arrows";
import { disposeTree } from "../displays/display";
import type { Pose } from "../generated/geometry_msgs";
import { toStamp } from "../ros/time";
import { Layer } from "../scene/layers";
import type { Pointer, Tool, ToolContext, ToolType } from "./tool";

const ARROW_M = 0.6;
const LIFT_M = 0.03;

/** RViz's covariance of a pose estimate: half a metre, and 15 degrees. */
const POSITION_VARIANCE = 0.25;
const YAW_VARIANCE = (Math.PI / 12) ** 2;

class PoseTool implements Tool {
  private readonly arrow = new Group();
  private start: Vector3 | undefined;
  private yaw = 0;

  constructor(
    private readonly context: ToolContext,
    color: string,
    private readonly verb: string,
    private readonly send: (pose: Pose, context: ToolContext) => void,
  ) {
    const material = new MeshBasicMaterial({ color, transparent: true, opacity: 0.95, depthTest: false });
    const ring = new Mesh(new RingGeometry(0.13, 0.17, 48), material);
    this.arrow.add(new Mesh(poseArrow(ARROW_M), material), ring);
    for (const part of this.arrow.children) {
      part.renderOrder = Layer.TOOL;
    }
    this.arrow.visible = false;
    context.overlay.add(this.arrow);
  }

  pressed({ ground }: Pointer): void {
    this.start = ground?.clone();
    if (this.start) {
      this.arrow.position.copy(this.start).z += LIFT_M;
      this.point(this.start);
    }
  }

  moved({ ground }: Pointer, isPressed: boolean): void {
    if (isPressed && ground && this.start) {
      this.point(ground);
    }
  }

  released({ ground }: Pointer): void {
    if (!this.start) {
      return;
    }
    this.point(ground ?? this.start);
    const { x, y } = this.start;
    this.send(
      {
        position: { x, y, z: 0 },
        orientation: { x: 0, y: 0, z: Math.sin(this.yaw / 2), w: Math.cos(this.yaw / 2) },
      },
      this.context,
    );
    this.context.finish();
  }

  dispose(): void {
    disposeTree(this.arrow);
    this.arrow.removeFromParent();
    this.context.invalidate();
  }

  private point(to: Vector3): void {
    const from = this.start as Vector3;
    if (Math.hypot(to.x - from.x, to.y - from.y) > 0.01) {
      this.yaw = Math.atan2(to.y - from.y, to.x - from.x);
    }
    this.arrow.rotation.set(0, 0, this.yaw);
    this.arrow.visible = true;
    const degrees = Math.round((this.yaw * 180) / Math.PI);
    this.context.showMessage(`${this.verb} x ${from.x.toFixed(2)} m, y ${from.y.toFixed(2)} m, yaw ${degrees}°`);
    this.context.invalidate();
  }
}

function header(context: ToolContext) {
  return { stamp: toStamp(context.now()), frame_id: context.fixedFrame() };
}

export const GOAL: ToolType = {
  id: "goal",
  title: "2D Goal Pose",
  key: "g",
  icon: "goal",
  hint: "Press at the goal position and drag in the direction of the heading",
  create: (context) =>
    new PoseTool(context, "#4fd17e", "Go to", (pose) =>
      context.publish("/goal_pose", "geometry_msgs/msg/PoseStamped", { header: header(context), pose }),
    ),
};

export const POSE_ESTIMATE: ToolType = {
  id: "estimate",
  title: "2D Pose Estimate",
  key: "p",
  icon: "estimate",
  hint: "Press at the robot's position and drag in the direction of its heading",
  create: (context) =>
    new PoseTool(context, "#a78bfa", "Robot is at", (pose) => {
      const covariance = new Float64Array(36);
      covariance[0] = covariance[7] = POSITION_VARIANCE;
      covariance[35] = YAW_VARIANCE;
      context.publish("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", {
        header: header(context),
        pose: { pose, covariance },
      });
    }),
};
