// MarkerArray: several markers in one message.
import type { BuiltInDisplay } from "../display";
import MARKER from "./marker";

export default {
  ...MARKER,
  id: "MarkerArray",
  messages: ["visualization_msgs/msg/MarkerArray"],
} satisfies BuiltInDisplay;
