"""A robot that navigates, as an object with methods."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import rclpy
from geometry_msgs.msg import Point, PoseStamped, PoseWithCovarianceStamped
from lifecycle_msgs.srv import GetState
from nav2_msgs.action import (
    AssistedTeleop,
    BackUp,
    ComputeAndTrackRoute,
    ComputePathThroughPoses,
    ComputePathToPose,
    ComputeRoute,
    DockRobot,
    DriveOnHeading,
    FollowGPSWaypoints,
    FollowPath,
    FollowWaypoints,
    NavigateThroughPoses,
    NavigateToPose,
    SmoothPath,
    Spin,
    UndockRobot,
)
from nav2_msgs.srv import LoadMap, ManageLifecycleNodes, Toggle
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

from nav2_simple_commander._costmaps import Costmaps
from nav2_simple_commander._tasks import RunningTask as RunningTask
from nav2_simple_commander._tasks import TaskResult as TaskResult
from nav2_simple_commander._tasks import duration

if TYPE_CHECKING:
    from geographic_msgs.msg import GeoPose
    from nav2_msgs.msg import Route
    from nav_msgs.msg import Path

_LATCHED = QoSProfile(
    depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL, reliability=QoSReliabilityPolicy.RELIABLE
)
_MANAGER = "nav2_msgs/srv/ManageLifecycleNodes"


class BasicNavigator(Costmaps):
    """Navigator that controls a robot by Nav2's actions and services.

    A method that starts a task returns it, or None where the server rejected it; `isTaskComplete`, `getFeedback` and
    `getResult` tell how it goes on. The methods spin the node, so nobody else may.

    Parameters
    ----------
    node_name, namespace
        Of the node.
    """

    def __init__(self, node_name: str = "basic_navigator", namespace: str = "") -> None:
        super().__init__(node_name, namespace)
        self.initial_pose = PoseStamped()
        self.initial_pose.header.frame_id = "map"
        self.initial_pose_received = False
        self.localization_pose_sub = self.create_subscription(
            PoseWithCovarianceStamped, "amcl_pose", self._note_pose, _LATCHED
        )
        self.initial_pose_pub = self.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)

    def destroyNode(self) -> None:
        """Destroy the node."""
        self.destroy_node()

    def destroy_node(self) -> None:
        """Destroy the node."""
        self._destroy_clients()
        super().destroy_node()

    def setInitialPose(self, initial_pose: PoseStamped) -> None:
        """Publish the robot's pose to the localization."""
        self.initial_pose_received = False
        self.initial_pose = initial_pose
        message = PoseWithCovarianceStamped(header=initial_pose.header)
        message.pose.pose = initial_pose.pose
        self.info("Publishing Initial Pose")
        self.initial_pose_pub.publish(message)

    # Tasks.

    def goToPose(self, pose: PoseStamped, behavior_tree: str = "") -> RunningTask | None:
        """Start to drive to a pose, by the tree in a file or the default one."""
        self.debug(f"Navigating to goal: {pose.pose.position.x} {pose.pose.position.y}")
        task = RunningTask.NAVIGATE_TO_POSE
        return self._start(task, NavigateToPose, "navigate_to_pose", pose=pose, behavior_tree=behavior_tree)

    def goThroughPoses(self, poses: Sequence[PoseStamped], behavior_tree: str = "") -> RunningTask | None:
        """Start to drive through poses, by the tree in a file or the default one."""
        task, poses = RunningTask.NAVIGATE_THROUGH_POSES, list(poses)
        return self._start(
            task, NavigateThroughPoses, "navigate_through_poses", poses=poses, behavior_tree=behavior_tree
        )

    def followWaypoints(
        self, poses: Sequence[PoseStamped], number_of_loops: int = 0, goal_index: int = 0
    ) -> RunningTask | None:
        """Start to stop at poses, from one of them on, and again so many times."""
        task, poses = RunningTask.FOLLOW_WAYPOINTS, list(poses)
        return self._start(
            task,
            FollowWaypoints,
            "follow_waypoints",
            poses=poses,
            number_of_loops=number_of_loops,
            goal_index=goal_index,
        )

    def followGpsWaypoints(self, gps_poses: Sequence[GeoPose]) -> RunningTask | None:
        """Start to stop at places on the earth."""
        task, places = RunningTask.FOLLOW_GPS_WAYPOINTS, list(gps_poses)
        return self._start(task, FollowGPSWaypoints, "follow_gps_waypoints", gps_poses=places)

    def spin(
        self, spin_dist: float = 1.57, time_allowance: float = 10, disable_collision_checks: bool = False
    ) -> RunningTask | None:
        """Start to turn by an angle [rad], within a time [s]."""
        return self._start(
            RunningTask.SPIN,
            Spin,
            "spin",
            target_yaw=float(spin_dist),
            time_allowance=duration(time_allowance),
            disable_collision_checks=disable_collision_checks or None,
        )

    def backup(
        self,
        backup_dist: float = 0.15,
        backup_speed: float = 0.025,
        time_allowance: float = 10,
        disable_collision_checks: bool = False,
    ) -> RunningTask | None:
        """Start to drive back by a distance [m] at a speed [m/s], within a time [s]."""
        return self._start(
            RunningTask.BACKUP,
            BackUp,
            "backup",
            target=Point(x=float(backup_dist)),
            speed=float(backup_speed),
            time_allowance=duration(time_allowance),
            disable_collision_checks=disable_collision_checks or None,
        )

    def driveOnHeading(
        self,
        dist: float = 0.15,
        speed: float = 0.025,
        time_allowance: float = 10,
        disable_collision_checks: bool = False,
    ) -> RunningTask | None:
        """Start to drive straight on by a distance [m] at a speed [m/s], within a time [s]."""
        return self._start(
            RunningTask.DRIVE_ON_HEADING,
            DriveOnHeading,
            "drive_on_heading",
            target=Point(x=float(dist)),
            speed=float(speed),
            time_allowance=duration(time_allowance),
            disable_collision_checks=disable_collision_checks or None,
        )

    def assistedTeleop(self, time_allowance: float = 30) -> RunningTask | None:
        """Start to let somebody drive for a time [s], and to keep the robot from collisions."""
        task = RunningTask.ASSISTED_TELEOP
        return self._start(task, AssistedTeleop, "assisted_teleop", time_allowance=duration(time_allowance))

    def followPath(
        self,
        path: Path,
        controller_id: str = "",
        goal_checker_id: str = "",
        progress_checker_id: str = "",
        path_handler_id: str = "",
    ) -> RunningTask | None:
        """Start to follow a path, by plugins of these names or the default ones."""
        return self._start(
            RunningTask.FOLLOW_PATH,
            FollowPath,
            "follow_path",
            path=path,
            controller_id=controller_id,
            goal_checker_id=goal_checker_id,
            progress_checker_id=progress_checker_id or None,
            path_handler_id=path_handler_id or None,
        )

    def dockRobotByPose(
        self, dock_pose: PoseStamped, dock_type: str = "", nav_to_dock: bool = True
    ) -> RunningTask | None:
        """Start to dock at a pose, after driving there unless that is not wanted."""
        return self._start(
            RunningTask.DOCK_ROBOT,
            DockRobot,
            "dock_robot",
            use_dock_id=False,
            dock_pose=dock_pose,
            dock_type=dock_type,
            navigate_to_staging_pose=nav_to_dock,
        )

    def dockRobotByID(self, dock_id: str, nav_to_dock: bool = True) -> RunningTask | None:
        """Start to dock at a dock that the server knows, after driving there unless that is not wanted."""
        return self._start(
            RunningTask.DOCK_ROBOT,
            DockRobot,
            "dock_robot",
            use_dock_id=True,
            dock_id=dock_id,
            navigate_to_staging_pose=nav_to_dock,
        )

    def undockRobot(self, dock_type: str = "") -> RunningTask | None:
        """Start to leave a dock."""
        return self._start(RunningTask.UNDOCK_ROBOT, UndockRobot, "undock_robot", dock_type=dock_type)

    def getAndTrackRoute(
        self, start: PoseStamped | int, goal: PoseStamped | int, use_start: bool = False
    ) -> RunningTask | None:
        """Start planning a route and tracking the robot on it; see `getRoute`."""
        fields = _ends_of_route(start, goal, use_start)
        return self._start(
            RunningTask.COMPUTE_AND_TRACK_ROUTE, ComputeAndTrackRoute, "compute_and_track_route", **fields
        )

    # Plans.

    def getPath(
        self, start: PoseStamped, goal: PoseStamped, planner_id: str = "", use_start: bool = False
    ) -> Path | None:
        """Return a path to a pose, None where there is none; from the robot unless `use_start`."""
        fields = {"start": start, "goal": goal, "planner_id": planner_id, "use_start": use_start}
        result = self._ask(ComputePathToPose, "compute_path_to_pose", **fields)
        return None if result is None else result.path

    def getPathThroughPoses(
        self, start: PoseStamped, goals: Sequence[PoseStamped], planner_id: str = "", use_start: bool = False
    ) -> Path | None:
        """Return a path through poses, None where there is none; from the robot unless `use_start`."""
        fields = {"start": start, "goals": list(goals), "planner_id": planner_id, "use_start": use_start}
        result = self._ask(ComputePathThroughPoses, "compute_path_through_poses", **fields)
        return None if result is None else result.path

    def getRoute(
        self, start: PoseStamped | int, goal: PoseStamped | int, use_start: bool = False
    ) -> list[Path | Route] | None:
        """Return a path and a route over a graph, None where there is none.

        Parameters
        ----------
        start, goal
            Poses, or nodes of the graph by their numbers.
        use_start
            Whether it begins at `start` rather than at the robot, where poses are given.
        """
        result = self._ask(ComputeRoute, "compute_route", **_ends_of_route(start, goal, use_start))
        return None if result is None else [result.path, result.route]

    def smoothPath(
        self, path: Path, smoother_id: str = "", max_duration: float = 2.0, check_for_collision: bool = False
    ) -> Path | None:
        """Return a smoother path, found within a time [s]; None where that failed."""
        result = self._ask(
            SmoothPath,
            "smooth_path",
            path=path,
            smoother_id=smoother_id,
            max_smoothing_duration=duration(max_duration),
            check_for_collisions=check_for_collision,
        )
        return None if result is None else result.path

    # The servers.

    def waitUntilNav2Active(self, navigator: str = "bt_navigator", localizer: str = "amcl") -> None:
        """Wait until navigation is active, and knows where the robot is.

        Parameters
        ----------
        navigator, localizer
            Names of the nodes; the localizer ``robot_localization`` is not waited for.
        """
        if localizer != "robot_localization":
            self._wait_for_node(localizer)
        if localizer == "amcl":
            while not self.initial_pose_received:
                self.info("Waiting for amcl_pose to be received")
                self.setInitialPose(self.initial_pose)
                rclpy.spin_once(self, timeout_sec=1.0)
        self._wait_for_node(navigator)
        self.info("Nav2 is ready for use!")

    def changeMap(self, map_filepath: str) -> bool:
        """Load another map in the map server; return whether it did."""
        response = self._call(LoadMap, "map_server/load_map", map_url=map_filepath)
        if response.result == LoadMap.Response.RESULT_SUCCESS:
            self.info("Change map request was successful!")
            return True
        self.setTaskError(response.result, f"Change map request failed with result {response.result}")
        self.error(self.last_action_error_msg)
        return False

    def toggleCollisionMonitor(self, enable: bool) -> None:
        """Switch the collision monitor on or off."""
        response = self._call(Toggle, "collision_monitor/toggle", enable=enable)
        if not response.success:
            self.error(f"Toggle collision monitor request failed: {response.message}")

    def lifecycleStartup(self) -> None:
        """Start the nodes of all lifecycle managers."""
        self._manage(ManageLifecycleNodes.Request.STARTUP, "Starting up")

    def lifecycleShutdown(self) -> None:
        """Shut down the nodes of all lifecycle managers."""
        self._manage(ManageLifecycleNodes.Request.SHUTDOWN, "Shutting down")

    def _manage(self, command: int, words: str) -> None:
        for name, types in self.get_service_names_and_types():
            if _MANAGER in types:
                self.info(f"{words} {name}")
                self._call(ManageLifecycleNodes, name, command=command)

    def _wait_for_node(self, node_name: str) -> None:
        self.debug(f"Waiting for {node_name} to become active..")
        while self._call(GetState, f"{node_name}/get_state").current_state.label != "active":
            rclpy.spin_once(self, timeout_sec=0.5)

    def _note_pose(self, message: Any) -> None:
        self.initial_pose_received = True


def _ends_of_route(start: PoseStamped | int, goal: PoseStamped | int, use_start: bool) -> dict[str, Any]:
    """Return the fields of a route's goal.

    Raises
    ------
    TypeError
        Where one end is a pose and the other a number.
    """
    if isinstance(start, int) and isinstance(goal, int):
        return {"start_id": start, "goal_id": goal, "use_poses": False}
    if isinstance(start, int) or isinstance(goal, int):
        raise TypeError("the start and the goal of a route are both poses, or both numbers of nodes")
    return {"start": start, "goal": goal, "use_start": use_start, "use_poses": True}
