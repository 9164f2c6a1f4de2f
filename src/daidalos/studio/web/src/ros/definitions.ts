// Definitions of the messages that the page itself publishes.
// The server's channels carry their own; these are needed before anyone else uses the type.

const SEPARATOR = "=".repeat(80);

const HEADER = "builtin_interfaces/Time stamp\nstring frame_id";
const TIME = "int32 sec\nuint32 nanosec";
const POINT = "float64 x\nfloat64 y\nfloat64 z";
const QUATERNION = "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1";
const POSE = "Point position\nQuaternion orientation";

function join(root: string, parts: Record<string, string>): string {
  return [root, ...Object.entries(parts).map(([name, text]) => `${SEPARATOR}\nMSG: ${name}\n${text}`)].join("\n");
}

const HEADERS = { "std_msgs/Header": HEADER, "builtin_interfaces/Time": TIME };
const POSES = {
  "geometry_msgs/Pose": POSE,
  "geometry_msgs/Point": POINT,
  "geometry_msgs/Quaternion": QUATERNION,
};

export const DEFINITIONS: Readonly<Record<string, string>> = {
  "geometry_msgs/msg/PointStamped": join("std_msgs/Header header\nPoint point", {
    ...HEADERS,
    "geometry_msgs/Point": POINT,
  }),
  "geometry_msgs/msg/PoseStamped": join("std_msgs/Header header\nPose pose", { ...HEADERS, ...POSES }),
  "geometry_msgs/msg/PoseWithCovarianceStamped": join("std_msgs/Header header\nPoseWithCovariance pose", {
    ...HEADERS,
    "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance",
    ...POSES,
  }),
};
