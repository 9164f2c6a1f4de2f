// The ROS messages that the page understands, as the CDR reader delivers them.
import type { Stamp } from "./time";

export interface Header {
  stamp: Stamp;
  frame_id: string;
}

export interface Vector3 {
  x: number;
  y: number;
  z: number;
}

export interface Quaternion extends Vector3 {
  w: number;
}

export interface Pose {
  position: Vector3;
  orientation: Quaternion;
}

export interface Stamped {
  header: Header;
}

export interface PoseStamped extends Stamped {
  pose: Pose;
}

export interface PoseArray extends Stamped {
  poses: Pose[];
}

export interface PoseWithCovarianceStamped extends Stamped {
  pose: { pose: Pose; covariance: Float64Array };
}

export interface PointStamped extends Stamped {
  point: Vector3;
}

export interface PolygonStamped extends Stamped {
  polygon: { points: Vector3[] };
}

export interface Path extends Stamped {
  poses: PoseStamped[];
}

export interface Odometry extends Stamped {
  child_frame_id: string;
  pose: { pose: Pose; covariance: Float64Array };
}

export interface TransformStamped extends Stamped {
  child_frame_id: string;
  transform: { translation: Vector3; rotation: Quaternion };
}

export interface TFMessage {
  transforms: TransformStamped[];
}

export interface LaserScan extends Stamped {
  angle_min: number;
  angle_max: number;
  angle_increment: number;
  time_increment: number;
  scan_time: number;
  range_min: number;
  range_max: number;
  ranges: Float32Array;
  intensities: Float32Array;
}

export interface PointField {
  name: string;
  offset: number;
  datatype: number;
  count: number;
}

export interface PointCloud2 extends Stamped {
  height: number;
  width: number;
  fields: PointField[];
  is_bigendian: boolean;
  point_step: number;
  row_step: number;
  data: Uint8Array;
  is_dense: boolean;
}

export interface OccupancyGrid extends Stamped {
  info: { map_load_time: Stamp; resolution: number; width: number; height: number; origin: Pose };
  data: Int8Array;
}

export interface OccupancyGridUpdate extends Stamped {
  x: number;
  y: number;
  width: number;
  height: number;
  data: Int8Array;
}

export interface ColorRGBA {
  r: number;
  g: number;
  b: number;
  a: number;
}

export interface Marker extends Stamped {
  ns: string;
  id: number;
  type: number;
  action: number;
  pose: Pose;
  scale: Vector3;
  color: ColorRGBA;
  lifetime: Stamp;
  frame_locked: boolean;
  points: Vector3[];
  colors: ColorRGBA[];
  /** Absent in what the page makes itself, and in the messages of older ROS. */
  texture_resource?: string;
  text: string;
  mesh_resource: string;
  mesh_use_embedded_materials: boolean;
}

export interface MarkerArray {
  markers: Marker[];
}

export interface StringMessage {
  data: string;
}

export interface Image extends Stamped {
  height: number;
  width: number;
  encoding: string;
  is_bigendian: number;
  step: number;
  data: Uint8Array;
}

export interface CompressedImage extends Stamped {
  format: string;
  data: Uint8Array;
}

export interface Log {
  stamp: Stamp;
  level: number;
  name: string;
  msg: string;
  file: string;
  function: string;
  line: number;
}
