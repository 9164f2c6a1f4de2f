// PoseWithCovariance: an arrow on the ellipse of its uncertainty.
import { CircleGeometry, Mesh, MeshBasicMaterial } from "three";
import type { Pose, PoseWithCovarianceStamped } from "../../generated/geometry_msgs";
import { Layer } from "../../scene/layers";
import type { Settings } from "../../contract";
import { ARROW_PROPERTIES, ArrowsDisplay } from "../arrows";
import type { DisplayContext, BuiltInDisplay } from "../display";
import { flag, number, text } from "../settings";

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

export default {
  id: "PoseWithCovariance",
  icon: "estimate",
  messages: ["geometry_msgs/msg/PoseWithCovarianceStamped"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    ...ARROW_PROPERTIES,
    { key: "covariance", label: "Covariance", kind: "toggle" },
  ],
  defaults: { topic: "", color: "#a78bfa", alpha: 1, length: 0.5, covariance: true },
  legend: ({ color }) => String(color),
  create: (context, settings) => new PoseWithCovarianceDisplay(context, settings),
} satisfies BuiltInDisplay;
