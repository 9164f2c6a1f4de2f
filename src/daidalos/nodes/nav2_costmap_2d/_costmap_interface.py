"""Topics and services of a costmap."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daidalos.common.arrays import Array
from daidalos.common.pose2 import compose
from daidalos.navigation.costmap.footprint import FootprintCollisionChecker
from daidalos.navigation.costmap.occupancy import to_occupancy
from daidalos.nodes.action_results import TransformFailed
from daidalos.nodes.conversions import grid_message, pose2_of
from daidalos.nodes.nav2_costmap_2d._costmap_messages import costmap_message, footprint_message, voxel_message
from daidalos.nodes.qos import LATCHED

if TYPE_CHECKING:
    from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode


class CostmapInterface:
    """Publishers of a costmap node, and its services that clear and return the costmap.

    Parameters
    ----------
    node : CostmapNode
    """

    def __init__(self, node: CostmapNode) -> None:
        from geometry_msgs.msg import PolygonStamped
        from nav2_msgs.msg import Costmap as CostmapMessage
        from nav2_msgs.msg import VoxelGrid as VoxelMessage
        from nav_msgs.msg import OccupancyGrid as GridMessage

        self._node = node
        self._grid_publisher = node.create_publisher(GridMessage, "costmap", LATCHED)
        self._raw_publisher = node.create_publisher(CostmapMessage, "costmap_raw", LATCHED)
        self._footprint_publisher = node.create_publisher(PolygonStamped, "published_footprint", 1)
        self._voxel_publisher = node.create_publisher(VoxelMessage, "voxel_grid", 1)
        self._create_services(node.get_name())

    def _create_services(self, name: str) -> None:
        from nav2_msgs.srv import (
            ClearCostmapAroundPose,
            ClearCostmapAroundRobot,
            ClearCostmapExceptRegion,
            ClearEntireCostmap,
            GetCostmap,
            GetCosts,
        )

        self._node.create_service(ClearEntireCostmap, f"clear_entirely_{name}", self._on_clear_entirely)
        self._node.create_service(ClearCostmapAroundRobot, f"clear_around_{name}", self._on_clear_around)
        self._node.create_service(ClearCostmapExceptRegion, f"clear_except_{name}", self._on_clear_except)
        self._node.create_service(ClearCostmapAroundPose, f"clear_around_pose_{name}", self._on_clear_around_pose)
        self._node.create_service(GetCosts, f"get_cost_{name}", self._on_get_costs)
        self._node.create_service(GetCostmap, "get_costmap", self._on_get_costmap)

    def publish(self) -> None:
        """Publish the costmap and the footprint on the topics that have subscribers."""
        stamp = self._node.get_clock().now().to_msg()
        if self._grid_publisher.handle.has_subscribers:
            costmap = self._node.snapshot()
            values = to_occupancy(costmap.costs)
            self._grid_publisher.publish(
                grid_message(values, costmap.resolution, costmap.origin, self._node.global_frame, stamp)
            )
        if self._raw_publisher.handle.has_subscribers:
            self._raw_publisher.publish(
                costmap_message(self._node.snapshot(), self._node.global_frame, stamp, self._node.updated)
            )
        if self._footprint_publisher.handle.has_subscribers:
            pose = self._node.robot_pose()
            if pose is not None:
                self._footprint_publisher.publish(
                    footprint_message(self._node.footprint, pose, self._node.global_frame, stamp)
                )

        if self._voxel_publisher.handle.has_subscribers and self._node.layered is not None:
            with self._node.lock:
                grids = [layer.voxels for layer in self._node.layered.layers if layer.enabled]
            for grid in grids:
                if grid is not None:
                    self._voxel_publisher.publish(voxel_message(grid, self._node.global_frame, stamp))

    def _on_clear_entirely(self, request: Any, response: Any) -> Any:
        with self._node.lock:
            if self._node.layered is not None:
                self._node.layered.clear_entirely()
        return response

    def _on_clear_around(self, request: Any, response: Any) -> Any:
        pose = self._node.robot_pose()
        with self._node.lock:
            if self._node.layered is not None and pose is not None:
                self._node.layered.clear_around(pose, request.reset_distance)
        return response

    def _on_clear_around_pose(self, request: Any, response: Any) -> Any:
        try:
            pose = self._pose(request.pose)
        except TransformFailed as problem:
            self._node.get_logger().error(f"nothing is cleared: {problem}")
            return response
        with self._node.lock:
            if self._node.layered is not None:
                self._node.layered.clear_around(pose, request.reset_distance)
        return response

    def _on_get_costs(self, request: Any, response: Any) -> Any:
        """Return the costs of poses, under the footprint where it is asked for; no success without a transform."""
        if self._node.layered is None:
            return response
        try:
            poses = [self._pose(pose) for pose in request.poses]
        except TransformFailed as problem:
            self._node.get_logger().error(f"there are no costs: {problem}")
            return response
        costmap = self._node.snapshot()
        checker = FootprintCollisionChecker(costmap, self._node.footprint)
        for pose in poses:
            cost = checker.footprint_cost_at(pose) if request.use_footprint else costmap.cost_at(pose[0], pose[1])
            response.costs.append(float(cost))
        response.success = True
        return response

    def _pose(self, stamped: Any) -> Array:
        """Return a pose (x, y, yaw) in the costmap's frame."""
        frame = stamped.header.frame_id or self._node.global_frame
        return compose(self._node.pose_of(frame), pose2_of(stamped.pose))

    def _on_clear_except(self, request: Any, response: Any) -> Any:
        pose = self._node.robot_pose()
        with self._node.lock:
            if self._node.layered is not None and pose is not None:
                self._node.layered.clear_except(pose, request.reset_distance)
        return response

    def _on_get_costmap(self, request: Any, response: Any) -> Any:
        response.map = costmap_message(
            self._node.snapshot(), self._node.global_frame, self._node.get_clock().now().to_msg(), self._node.updated
        )
        return response
