// The kinds of displays: adding one means a file beside this one and a line below.
import type { DisplayType } from "./display";
import { GRID } from "./grid";
import { LASER_SCAN } from "./laser_scan";
import { MARKER, MARKER_ARRAY } from "./marker";
import { OCCUPANCY_GRID } from "./occupancy_grid";
import { ODOMETRY } from "./odometry";
import { PATH } from "./path";
import { POINT } from "./point";
import { POINT_CLOUD } from "./point_cloud";
import { POLYGON } from "./polygon";
import { POSE, POSE_ARRAY, POSE_WITH_COVARIANCE } from "./poses";
import { ROBOT_MODEL } from "./robot_model";
import { TF } from "./tf";

export const DISPLAY_TYPES: readonly DisplayType[] = [
  GRID,
  TF,
  ROBOT_MODEL,
  LASER_SCAN,
  OCCUPANCY_GRID,
  PATH,
  POSE,
  POSE_WITH_COVARIANCE,
  POSE_ARRAY,
  ODOMETRY,
  MARKER,
  MARKER_ARRAY,
  POINT_CLOUD,
  POINT,
  POLYGON,
];

export function displayType(name: string): DisplayType | undefined {
  return DISPLAY_TYPES.find(({ type }) => type === name);
}

/** The display that shows a message type, where there is one. */
export function displayFor(message: string): DisplayType | undefined {
  // std_msgs/String is a robot's description by its topic only, not by its type.
  return DISPLAY_TYPES.find(({ type, messages }) => type !== "RobotModel" && messages.includes(message));
}
