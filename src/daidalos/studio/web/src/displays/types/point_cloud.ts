// PointCloud2: points of any layout, coloured by height, by a field, or by their own colours.
import { type PointCloud2, PointField } from "../../generated/sensor_msgs";
import type { BuiltInDisplay } from "../display";
import { paintByValue, paintFlat, POINT_PROPERTIES, PointsDisplay, type PointWriter } from "../points_display";
import { text } from "../settings";

type Getter = (offset: number) => number;

class PointCloudDisplay extends PointsDisplay<PointCloud2> {
  private values = new Float32Array();

  protected override capacity(cloud: PointCloud2): number {
    return cloud.width * cloud.height;
  }

  protected override write(cloud: PointCloud2, { positions, colors }: PointWriter): number {
    const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
    const read = (name: string) => getter(view, cloud, name);
    const [x, y, z] = [read("x"), read("y"), read("z")];
    if (!x || !y || !z) {
      this.report("error", "the cloud has no x, y and z");
      return 0;
    }
    const by = text(this.settings, "colorBy");
    const rgb = by === "rgb" ? packedColor(view, cloud) : undefined;
    const value = { x, y, z, intensity: read("intensity") }[by];
    const total = Math.min(this.capacity(cloud), Math.floor(cloud.data.byteLength / Math.max(1, cloud.point_step)));
    if (this.values.length < total) {
      this.values = new Float32Array(total);
    }
    let count = 0;
    for (let i = 0; i < total; i++) {
      const row = Math.floor(i / cloud.width);
      const offset = row * cloud.row_step + (i - row * cloud.width) * cloud.point_step;
      const [px, py, pz] = [x(offset), y(offset), z(offset)];
      // What was not hit is not a number in the clouds of cameras, and infinitely far in those of lidars.
      if (!Number.isFinite(px + py + pz)) {
        continue;
      }
      positions[3 * count] = px;
      positions[3 * count + 1] = py;
      positions[3 * count + 2] = pz;
      if (rgb) {
        const color = rgb(offset);
        colors[3 * count] = (color >> 16) & 255;
        colors[3 * count + 1] = (color >> 8) & 255;
        colors[3 * count + 2] = color & 255;
      } else if (value) {
        this.values[count] = value(offset);
      }
      count++;
    }
    if (!rgb && value) {
      paintByValue(this.values, count, colors);
    } else if (!rgb) {
      paintFlat(text(this.settings, "color"), count, colors);
    }
    return count;
  }
}

function getter(view: DataView, cloud: PointCloud2, name: string): Getter | undefined {
  const field = cloud.fields.find((each) => each.name === name);
  return field && readField(view, field, !cloud.is_bigendian);
}

function readField(view: DataView, { offset: at, datatype }: PointField, little: boolean): Getter | undefined {
  switch (datatype) {
    case PointField.INT8:
      return (offset) => view.getInt8(offset + at);
    case PointField.UINT8:
      return (offset) => view.getUint8(offset + at);
    case PointField.INT16:
      return (offset) => view.getInt16(offset + at, little);
    case PointField.UINT16:
      return (offset) => view.getUint16(offset + at, little);
    case PointField.INT32:
      return (offset) => view.getInt32(offset + at, little);
    case PointField.UINT32:
      return (offset) => view.getUint32(offset + at, little);
    case PointField.FLOAT32:
      return (offset) => view.getFloat32(offset + at, little);
    case PointField.FLOAT64:
      return (offset) => view.getFloat64(offset + at, little);
  }
  return undefined;
}

/** PCL packs red, green and blue into the bits of one 32-bit field, often declared as a float. */
function packedColor(view: DataView, cloud: PointCloud2): Getter | undefined {
  const field = cloud.fields.find(({ name }) => name === "rgb" || name === "rgba");
  return field && ((offset) => view.getUint32(offset + field.offset, !cloud.is_bigendian));
}

export default {
  id: "PointCloud2",
  icon: "cloud",
  discovery: "appears",
  messages: ["sensor_msgs/msg/PointCloud2"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    {
      key: "colorBy",
      label: "Colour by",
      kind: "choice",
      options: [
        ["z", "Height (z)"],
        ["x", "x"],
        ["y", "y"],
        ["intensity", "Intensity"],
        ["rgb", "RGB"],
        ["flat", "Flat colour"],
      ],
    },
    { key: "color", label: "Colour", kind: "color", when: (settings) => settings.colorBy === "flat" },
    ...POINT_PROPERTIES,
  ],
  defaults: {
    topic: "",
    colorBy: "z",
    color: "#7cc4ff",
    style: "points",
    pixels: 2,
    metres: 0.01,
    alpha: 1,
    decay: 0,
  },
  legend: ({ color, colorBy }) => (colorBy === "flat" ? String(color) : undefined),
  create: (context, settings) => new PointCloudDisplay(context, settings),
} satisfies BuiltInDisplay;
