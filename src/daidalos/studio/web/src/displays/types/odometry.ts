// Odometry: where the robot has been, as a trail of arrows.
import { Quaternion, Vector3 } from "three";
import type { Pose } from "../../generated/geometry_msgs";
import type { Odometry } from "../../generated/nav_msgs";
import { ARROW_PROPERTIES, ArrowsDisplay } from "../arrows";
import type { BuiltInDisplay } from "../display";
import { number } from "../settings";

const MAX_ARROWS = 2000;

class OdometryDisplay extends ArrowsDisplay<Odometry> {
  private trail: Pose[] = [];

  protected override posesOf({ pose: { pose } }: Odometry): readonly Pose[] {
    const last = this.trail.at(-1);
    if (!last || isFar(last, pose, number(this.settings, "distance"), number(this.settings, "angle"))) {
      this.trail.push(pose);
    }
    this.trail = this.trail.slice(-Math.min(MAX_ARROWS, number(this.settings, "keep")));
    return this.trail;
  }
}

function isFar(a: Pose, b: Pose, distance: number, angle: number): boolean {
  const [p, q] = [a.position, b.position];
  const [s, t] = [a.orientation, b.orientation];
  const turned = new Quaternion(s.x, s.y, s.z, s.w).angleTo(new Quaternion(t.x, t.y, t.z, t.w));
  return new Vector3(q.x - p.x, q.y - p.y, q.z - p.z).length() >= distance || turned >= angle;
}

export default {
  id: "Odometry",
  icon: "arrow",
  messages: ["nav_msgs/msg/Odometry"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    ...ARROW_PROPERTIES,
    { key: "keep", label: "Keep", kind: "number", min: 1, max: MAX_ARROWS, step: 10 },
    { key: "distance", label: "Every", kind: "number", min: 0, max: 10, step: 0.05, unit: "m" },
    { key: "angle", label: "or every", kind: "number", min: 0, max: 3.2, step: 0.05, unit: "rad" },
  ],
  defaults: { topic: "/odom", color: "#fb923c", alpha: 0.9, length: 0.2, keep: 200, distance: 0.2, angle: 0.3 },
  legend: ({ color }) => String(color),
  create: (context, settings) => new OdometryDisplay(context, settings),
} satisfies BuiltInDisplay;
