// Pose: one arrow.
import type { Pose, PoseStamped } from "../../generated/geometry_msgs";
import { ARROW_PROPERTIES, ArrowsDisplay } from "../arrows";
import type { BuiltInDisplay } from "../display";

class PoseDisplay extends ArrowsDisplay<PoseStamped> {
  protected override posesOf({ pose }: PoseStamped): readonly Pose[] {
    return [pose];
  }
}

export default {
  id: "Pose",
  icon: "goal",
  messages: ["geometry_msgs/msg/PoseStamped"],
  properties: [{ key: "topic", label: "Topic", kind: "topic" }, ...ARROW_PROPERTIES],
  defaults: { topic: "/goal_pose", color: "#f472b6", alpha: 1, length: 0.5 },
  legend: ({ color }) => String(color),
  create: (context, settings) => new PoseDisplay(context, settings),
} satisfies BuiltInDisplay;
