// PoseArray: many arrows.
import type { Pose, PoseArray } from "../../generated/geometry_msgs";
import { ARROW_PROPERTIES, ArrowsDisplay } from "../arrows";
import type { BuiltInDisplay } from "../display";

class PoseArrayDisplay extends ArrowsDisplay<PoseArray> {
  protected override posesOf({ poses }: PoseArray): readonly Pose[] {
    return poses;
  }

  protected override describe({ poses }: PoseArray): string {
    return `${poses.length} poses`;
  }
}

export default {
  id: "PoseArray",
  icon: "arrow",
  discovery: "appears",
  messages: ["geometry_msgs/msg/PoseArray"],
  properties: [{ key: "topic", label: "Topic", kind: "topic" }, ...ARROW_PROPERTIES],
  defaults: { topic: "", color: "#60a5fa", alpha: 0.9, length: 0.15 },
  legend: ({ color }) => String(color),
  create: (context, settings) => new PoseArrayDisplay(context, settings),
} satisfies BuiltInDisplay;
