"""Transforming point clouds; importing it registers them with `tf2_ros`."""

from .tf2_sensor_msgs import do_transform_cloud as do_transform_cloud
from .tf2_sensor_msgs import from_msg_msg as from_msg_msg
from .tf2_sensor_msgs import to_msg_msg as to_msg_msg
from .tf2_sensor_msgs import transform_points as transform_points
