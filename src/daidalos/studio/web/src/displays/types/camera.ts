// Camera: the pictures of a camera, with the scene as that camera sees it drawn over them, in a panel of their own.
import type { BuiltInDisplay } from "../display";
import { PictureDisplay } from "../picture_display";

export default {
  id: "Camera",
  icon: "camera",
  discovery: "hidden",
  messages: ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"],
  properties: [
    { key: "topic", label: "Topic", kind: "topic" },
    { key: "alpha", label: "Overlay alpha", kind: "number", min: 0, max: 1, step: 0.05 },
  ],
  defaults: { topic: "", alpha: 0.5 },
  create: (context, settings) => new PictureDisplay(context, settings),
} satisfies BuiltInDisplay;
