"""Requests of a navigator to costmaps."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCostmap,
)

from nav2_simple_commander._tasks import Tasks

if TYPE_CHECKING:
    from geometry_msgs.msg import PoseStamped
    from nav2_msgs.msg import Costmap


class Costmaps(Tasks):
    """The part of the navigator that clears and looks at costmaps."""

    def clearAllCostmaps(self) -> None:
        """Clear both costmaps."""
        self.clearLocalCostmap()
        self.clearGlobalCostmap()

    def clearLocalCostmap(self) -> None:
        """Clear the costmap around the robot."""
        self._call(ClearEntireCostmap, "local_costmap/clear_entirely_local_costmap")

    def clearGlobalCostmap(self) -> None:
        """Clear the costmap of the whole map."""
        self._call(ClearEntireCostmap, "global_costmap/clear_entirely_global_costmap")

    def clearCostmapExceptRegion(self, reset_distance: float) -> None:
        """Clear the local costmap, but not within a distance [m] of the robot."""
        name = "local_costmap/clear_except_local_costmap"
        self._call(ClearCostmapExceptRegion, name, reset_distance=float(reset_distance))

    def clearCostmapAroundRobot(self, reset_distance: float) -> None:
        """Clear the local costmap within a distance [m] of the robot."""
        name = "local_costmap/clear_around_local_costmap"
        self._call(ClearCostmapAroundRobot, name, reset_distance=float(reset_distance))

    def clearCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear the local costmap within a distance [m] of a pose, by the method's name in ROS 2 Jazzy."""
        self.clearLocalCostmapAroundPose(pose, reset_distance)

    def clearLocalCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear the local costmap within a distance [m] of a pose."""
        name = "local_costmap/clear_around_pose_local_costmap"
        self._call(ClearCostmapAroundPose, name, pose=pose, reset_distance=float(reset_distance))

    def clearGlobalCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear the global costmap within a distance [m] of a pose."""
        name = "global_costmap/clear_around_pose_global_costmap"
        self._call(ClearCostmapAroundPose, name, pose=pose, reset_distance=float(reset_distance))

    def getGlobalCostmap(self) -> Costmap:
        """Return the costmap of the whole map."""
        costmap: Costmap = self._call(GetCostmap, "global_costmap/get_costmap").map
        return costmap

    def getLocalCostmap(self) -> Costmap:
        """Return the costmap around the robot."""
        costmap: Costmap = self._call(GetCostmap, "local_costmap/get_costmap").map
        return costmap
