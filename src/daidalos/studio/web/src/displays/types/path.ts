// Path: the way ahead, as a line over the ground.
import type { Path } from "../../generated/nav_msgs";
import { Layer } from "../../scene/layers";
import { setLinePoints, thickLine } from "../../scene/shapes";
import type { Settings } from "../../contract";
import type { DisplayContext, BuiltInDisplay } from "../display";
import { number, text } from "../settings";
import { StampedDisplay } from "../topic_display";

class PathDisplay extends StampedDisplay<Path> {
  private readonly line = thickLine("#fff", 3);

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings, "latest");
    this.line.renderOrder = Layer.LINE;
    this.object.add(this.line);
  }

  protected override show(path: Path): void {
    const lift = number(this.settings, "offset");
    const points = new Float32Array(3 * path.poses.length);
    path.poses.forEach(({ pose: { position } }, i) => points.set([position.x, position.y, position.z + lift], 3 * i));
    setLinePoints(this.line, points);
    this.line.material.color.set(text(this.settings, "color"));
    this.line.material.linewidth = number(this.settings, "width");
    this.line.material.opacity = number(this.settings, "alpha");
  }

  protected override describe(path: Path): string {
    const length = path.poses.reduce((sum, { pose: { position: b } }, i) => {
      const a = path.poses[i - 1]?.pose.position;
      return a ? sum + Math.hypot(b.x - a.x, b.y - a.y, b.z - a.z) : 0;
    }, 0);
    return `${path.poses.length} poses, ${length.toFixed(2)} m`;
  }
}

export default {
  id: "Path",
  icon: "path",
  discovery: "appears",
  messages: ["nav_msgs/msg/Path"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    { key: "color", label: "Colour", kind: "color" },
    { key: "width", label: "Line width", kind: "number", min: 1, max: 20, step: 0.5, unit: "px" },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
    { key: "offset", label: "Height", kind: "number", min: -10, max: 10, step: 0.01, unit: "m" },
  ],
  defaults: { topic: "/plan", color: "#4fd17e", width: 3.5, alpha: 1, offset: 0.02 },
  legend: ({ color }) => String(color),
  create: (context, settings) => new PathDisplay(context, settings),
} satisfies BuiltInDisplay;
