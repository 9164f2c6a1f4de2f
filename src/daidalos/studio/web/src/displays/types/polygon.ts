// Polygon: an outline, such as the robot's footprint.
import type { PolygonStamped } from "../../generated/geometry_msgs";
import { Layer } from "../../scene/layers";
import { setLinePoints, thickLine } from "../../scene/shapes";
import type { Settings } from "../../contract";
import type { DisplayContext, BuiltInDisplay } from "../display";
import { number, text } from "../settings";
import { StampedDisplay } from "../topic_display";

class PolygonDisplay extends StampedDisplay<PolygonStamped> {
  private readonly line = thickLine("#fff", 2);

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings, "latest");
    this.line.renderOrder = Layer.OUTLINE;
    this.object.add(this.line);
  }

  protected override show({ polygon: { points } }: PolygonStamped): void {
    const closed = points.length > 2 ? [...points, points[0] as (typeof points)[number]] : points;
    setLinePoints(
      this.line,
      closed.flatMap(({ x, y, z }) => [x, y, z + 0.012]),
    );
    this.line.material.color.set(text(this.settings, "color"));
    this.line.material.linewidth = number(this.settings, "width");
    this.line.material.opacity = number(this.settings, "alpha");
  }

  protected override describe({ polygon }: PolygonStamped): string {
    return `${polygon.points.length} corners`;
  }
}

export default {
  id: "Polygon",
  icon: "polygon",
  messages: ["geometry_msgs/msg/PolygonStamped"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    { key: "color", label: "Colour", kind: "color" },
    { key: "width", label: "Line width", kind: "number", min: 1, max: 20, step: 0.5, unit: "px" },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  ],
  defaults: { topic: "", color: "#67e8f9", width: 2, alpha: 0.9 },
  legend: ({ color }) => String(color),
  create: (context, settings) => new PolygonDisplay(context, settings),
} satisfies BuiltInDisplay;
