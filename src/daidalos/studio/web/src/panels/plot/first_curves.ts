// What a plot shows until the user chooses.
import type { Studio } from "../../app/studio";
import { splitPath } from "../../ros/fields";
import { type Curve, curveOf } from "./curves";

/** What everyone's robot has: a plot that moves is a better first sight than an empty one. */
const PATHS = ["/odom/twist/twist/linear/x", "/odom/twist/twist/angular/z"];

/** Curves of the fields among these whose topics are there. */
export function firstCurves(studio: Studio): readonly Curve[] {
  const topics = studio.session.topics.value.map(({ name }) => name);
  return PATHS.filter((path) => splitPath(path, topics)).map((path) => curveOf(path));
}
