// Image: the pictures of a topic, in a panel of their own.
import type { BuiltInDisplay } from "../display";
import { PictureDisplay } from "../picture_display";

export default {
  id: "Image",
  icon: "image",
  messages: ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"],
  properties: [{ key: "topic", label: "Topic", kind: "topic" }],
  defaults: { topic: "" },
  create: (context, settings) => new PictureDisplay(context, settings),
} satisfies BuiltInDisplay;
