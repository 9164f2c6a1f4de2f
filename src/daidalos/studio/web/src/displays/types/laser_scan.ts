// LaserScan: where the beams ended.
import type { LaserScan } from "../../generated/sensor_msgs";
import type { BuiltInDisplay } from "../display";
import { paintByValue, paintFlat, POINT_PROPERTIES, PointsDisplay, type PointWriter } from "../points_display";
import { text } from "../settings";

class LaserScanDisplay extends PointsDisplay<LaserScan> {
  private values = new Float32Array();

  protected override capacity(scan: LaserScan): number {
    return scan.ranges.length;
  }

  protected override write(scan: LaserScan, { positions, colors }: PointWriter): number {
    const by = text(this.settings, "colorBy");
    const source = by === "intensity" ? scan.intensities : scan.ranges;
    const values = this.roomForValues(scan.ranges.length);
    let count = 0;
    for (let i = 0; i < scan.ranges.length; i++) {
      const range = scan.ranges[i] as number;
      // Written so that NaN is left out as well.
      if (!(range >= scan.range_min && range <= scan.range_max)) {
        continue;
      }
      const angle = scan.angle_min + i * scan.angle_increment;
      positions[3 * count] = range * Math.cos(angle);
      positions[3 * count + 1] = range * Math.sin(angle);
      positions[3 * count + 2] = 0;
      values[count] = source[i] ?? 0;
      count++;
    }
    if (by === "flat" || source.length === 0) {
      paintFlat(text(this.settings, "color"), count, colors);
    } else {
      paintByValue(values, count, colors);
    }
    return count;
  }

  private roomForValues(count: number): Float32Array {
    if (this.values.length < count) {
      this.values = new Float32Array(count);
    }
    return this.values;
  }
}

export default {
  id: "LaserScan",
  icon: "scan",
  discovery: "appears",
  messages: ["sensor_msgs/msg/LaserScan"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    {
      key: "colorBy",
      label: "Colour by",
      kind: "choice",
      options: [
        ["flat", "Flat colour"],
        ["intensity", "Intensity"],
        ["range", "Range"],
      ],
    },
    { key: "color", label: "Colour", kind: "color", when: (settings) => settings.colorBy === "flat" },
    ...POINT_PROPERTIES,
  ],
  defaults: {
    topic: "/scan",
    colorBy: "flat",
    color: "#e36bff",
    style: "points",
    pixels: 4,
    metres: 0.03,
    alpha: 1,
    decay: 0,
  },
  legend: ({ color, colorBy }) => (colorBy === "flat" ? String(color) : undefined),
  create: (context, settings) => new LaserScanDisplay(context, settings),
} satisfies BuiltInDisplay;
