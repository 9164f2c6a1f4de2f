"""Transforming the messages of ``geometry_msgs``; importing it registers them with `tf2_ros`."""

from typing import TYPE_CHECKING

from geometry_msgs.msg import PointStamped as PointStamped
from geometry_msgs.msg import PoseStamped as PoseStamped
from geometry_msgs.msg import PoseWithCovarianceStamped as PoseWithCovarianceStamped
from geometry_msgs.msg import Vector3Stamped as Vector3Stamped
from geometry_msgs.msg import WrenchStamped as WrenchStamped
from rclpy.impl.lazy_reexport import lazy_reexport

from .tf2_geometry_msgs import do_transform_point as do_transform_point
from .tf2_geometry_msgs import do_transform_polygon_stamped as do_transform_polygon_stamped
from .tf2_geometry_msgs import do_transform_pose as do_transform_pose
from .tf2_geometry_msgs import do_transform_pose_array as do_transform_pose_array
from .tf2_geometry_msgs import do_transform_pose_stamped as do_transform_pose_stamped
from .tf2_geometry_msgs import do_transform_pose_with_covariance_stamped as do_transform_pose_with_covariance_stamped
from .tf2_geometry_msgs import do_transform_quaternion as do_transform_quaternion
from .tf2_geometry_msgs import do_transform_transform as do_transform_transform
from .tf2_geometry_msgs import do_transform_vector3 as do_transform_vector3
from .tf2_geometry_msgs import do_transform_wrench as do_transform_wrench
from .tf2_geometry_msgs import from_msg_msg as from_msg_msg
from .tf2_geometry_msgs import to_msg_msg as to_msg_msg
from .tf2_geometry_msgs import transform_covariance as transform_covariance

if not TYPE_CHECKING:
    __getattr__ = lazy_reexport(
        __name__,
        {"geometry_msgs.msg": ("TransformStamped",)},
    )
