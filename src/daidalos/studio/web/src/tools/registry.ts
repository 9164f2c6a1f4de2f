// The tools of the 3-D view, in the order of the toolbar.
import { FOCUS, MEASURE, PUBLISH_POINT } from "./point_tools";
import { GOAL, POSE_ESTIMATE } from "./pose_tools";
import type { ToolType } from "./tool";

export const MOVE_CAMERA: ToolType = {
  id: "move",
  title: "Move Camera",
  key: "m",
  icon: "move",
  hint: "",
};

export const TOOLS: readonly ToolType[] = [MOVE_CAMERA, FOCUS, MEASURE, GOAL, POSE_ESTIMATE, PUBLISH_POINT];
