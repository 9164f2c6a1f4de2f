// PointStamped: a ball, such as the point that was clicked.
import { Mesh, MeshStandardMaterial, SphereGeometry } from "three";
import type { PointStamped } from "../../generated/geometry_msgs";
import type { Settings } from "../../contract";
import type { DisplayContext, BuiltInDisplay } from "../display";
import { number, text } from "../settings";
import { StampedDisplay } from "../topic_display";

class PointDisplay extends StampedDisplay<PointStamped> {
  private readonly ball = new Mesh(new SphereGeometry(1, 24, 16), new MeshStandardMaterial({ roughness: 0.6 }));

  constructor(context: DisplayContext, settings: Settings) {
    super(context, settings, "latest");
    this.object.add(this.ball);
  }

  protected override show({ point }: PointStamped): void {
    this.ball.position.set(point.x, point.y, point.z);
    this.ball.scale.setScalar(number(this.settings, "radius"));
    this.ball.material.color.set(text(this.settings, "color"));
    this.ball.material.opacity = number(this.settings, "alpha");
    this.ball.material.transparent = this.ball.material.opacity < 1;
  }
}

export default {
  id: "PointStamped",
  icon: "point",
  messages: ["geometry_msgs/msg/PointStamped"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    { key: "color", label: "Colour", kind: "color" },
    { key: "radius", label: "Radius", kind: "number", min: 0.005, max: 5, step: 0.01, unit: "m" },
    { key: "alpha", label: "Alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  ],
  defaults: { topic: "/clicked_point", color: "#facc15", radius: 0.06, alpha: 1 },
  legend: ({ color }) => String(color),
  create: (context, settings) => new PointDisplay(context, settings),
} satisfies BuiltInDisplay;
