// A view that shows what is there: everything, or less where even a pinned robot would be too small to be seen.
import { Box3, Vector3 } from "three";
import { FIELD_OF_VIEW_DEG, HOME, positionOf, type ViewState } from "./view";

/** What there is to see, and the robot in it, which must be seen; empty boxes where there is none. */
export interface Content {
  all: Box3;
  robot: Box3;
  /** Whether nothing is between two points, but for what is within a distance of the second. */
  sees?: (from: Vector3, to: Vector3, within: number) => boolean;
}

/** The robot's diagonal has at least this share of the view's height. */
const MIN_ROBOT_SHARE = 0.022;
/** How steeply one looks down in turn until no wall hides the robot, in radians. */
const STEEPER = [0.85, 1.1, 1.35];
/** What is framed leaves this share of the view free around it, for the bars over its edges. */
const MARGIN = 0.14;
/** Nearer than this, in metres, nothing is framed: a small thing alone needs its surroundings. */
const NEAREST_M = 0.9;
/** Around a robot that is alone there is so much of its size. */
const ALONE_MARGIN = 0.25;
/** How far the robot may be from the middle of the view, in half heights of the view. */
const MAX_ROBOT_OFFSET = 0.55;

/** The smallest orbit view from the home direction, or from more above, that shows everything, and the robot well. */
export function frameView({ all, robot, sees }: Content, aspect: number, from: ViewState = HOME): ViewState {
  const home = frameFrom(from, all, robot, aspect);
  if (robot.isEmpty() || !sees) {
    return home;
  }
  const at = robot.getCenter(new Vector3());
  const within = robot.getSize(new Vector3()).length();
  const views = [home, ...STEEPER.map((pitch) => frameFrom({ ...from, pitch }, all, robot, aspect))];
  return views.find((view) => sees(positionOf(view), at, within)) ?? home;
}

function frameFrom(from: ViewState, all: Box3, robot: Box3, aspect: number): ViewState {
  const whole = fit(withSurroundings(all, robot), aspect, from);
  const distance = Math.max(NEAREST_M, whole.distance);
  const slope = Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360);
  const near = robot.isEmpty() ? Infinity : robot.getSize(new Vector3()).length() / (2 * slope * MIN_ROBOT_SHARE);
  if (near >= distance) {
    return { ...from, kind: "orbit", focus: whole.focus.toArray(), distance };
  }
  const focus = robot.getCenter(new Vector3());
  const aside = whole.focus.clone().sub(focus).setZ(0);
  focus.add(aside.clampLength(0, MAX_ROBOT_OFFSET * slope * near));
  return { ...from, kind: "orbit", focus: focus.toArray(), distance: Math.max(NEAREST_M, near) };
}

/** Where the robot is alone, some of the ground around it. */
function withSurroundings(all: Box3, robot: Box3): Box3 {
  const isAlone = !robot.isEmpty() && robot.containsBox(all);
  return isAlone ? all.clone().expandByScalar(ALONE_MARGIN * all.getSize(new Vector3()).length()) : all;
}

/** Fit the corners of a box tightly: each side of the view touches one of them, or the box is centred between two. */
function fit(box: Box3, aspect: number, { yaw, pitch }: ViewState): { focus: Vector3; distance: number } {
  const ahead = new Vector3(-Math.cos(yaw) * Math.cos(pitch), -Math.sin(yaw) * Math.cos(pitch), -Math.sin(pitch));
  const right = new Vector3(ahead.y, -ahead.x, 0).normalize();
  const up = right.clone().cross(ahead);
  const slope = Math.tan((FIELD_OF_VIEW_DEG * Math.PI) / 360) * (1 - MARGIN);
  const corners = cornersOf(box);
  const across = limits(corners, right, ahead, slope * aspect);
  const upwards = limits(corners, up, ahead, slope);
  const depth = Math.min(across.depth, upwards.depth);
  const position = right
    .multiplyScalar(across.middle)
    .add(up.multiplyScalar(upwards.middle))
    .addScaledVector(ahead, depth);
  const distance = box.getCenter(new Vector3()).sub(position).dot(ahead);
  return { focus: position.addScaledVector(ahead, distance), distance };
}

/** How far ahead the camera may be so that all points are between two sides of the view, and where between them. */
function limits(points: readonly Vector3[], side: Vector3, ahead: Vector3, slope: number) {
  let [left, right] = [Infinity, Infinity];
  for (const point of points) {
    const [along, across] = [point.dot(ahead) * slope, point.dot(side)];
    left = Math.min(left, along + across);
    right = Math.min(right, along - across);
  }
  return { depth: (left + right) / (2 * slope), middle: (left - right) / 2 };
}

function cornersOf({ min, max }: Box3): Vector3[] {
  return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))));
}
