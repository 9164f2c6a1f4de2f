"""A robot that drives through a small arena, as real messages: what the page's tests look at.

`python -m studio.demo_robot` (from the folder of the tests) serves it to a browser.
"""

import math
import threading
import time
from pathlib import Path

import numpy as np

import daidalos
from daidalos.description.xacro import load_xacro

from .memory_source import MemorySource, decode, encode, make

SHARE = Path(daidalos.__file__).parent / "share"
STEP_S = 1 / 50
BEAMS = 820
RESOLUTION = 0.05
HALF_M = 4.0
CELLS = round(2 * HALF_M / RESOLUTION)
POSTS = np.array(
    [
        (-1.8, 1.6, 0.35),
        (1.7, 1.9, 0.28),
        (2.2, -1.4, 0.4),
        (-1.4, -1.9, 0.3),
        (0.3, 2.9, 0.2),
        (-3.0, 0.1, 0.25),
    ]
)
WALL_M = 3.8
SCAN_MOUNT = (-0.064, 0.0, 0.132)


class DemoRobot:
    """Drives to where it is sent, else along a loop; publishes what a navigating robot publishes."""

    def __init__(self, source: MemorySource, *, maps: bool = True) -> None:
        self.source = source
        self.x, self.y, self.yaw = 0.0, -0.4, 0.5
        self.goal: tuple[float, float, float] | None = None
        self.goals: list[tuple[float, float, float]] = []
        self.now = 12.0
        self.speed, self.turn = 0.0, 0.0
        self.track: list[tuple[float, float, float]] = []
        """Where it was in each step: time [s], x and y [m]."""
        self._maps = maps
        self._seen = np.zeros((CELLS, CELLS), dtype=bool)
        self._truth = _truth()
        self._costs = _inflate(self._truth)
        self._path: list[tuple[float, float]] = []
        self._steps = 0
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None
        self._advertise()

    def start(self) -> None:
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    def __enter__(self) -> "DemoRobot":
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _advertise(self) -> None:
        add = self.source.add_topic
        add("/clock", "rosgraph_msgs/msg/Clock")
        add("/tf", "tf2_msgs/msg/TFMessage")
        add("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
        add("/robot_description", "std_msgs/msg/String", latched=True)
        add("/scan", "sensor_msgs/msg/LaserScan")
        add("/odom", "nav_msgs/msg/Odometry")
        add("/plan", "nav_msgs/msg/Path")
        add("/rosout", "rcl_interfaces/msg/Log", latched=True)
        add("/goal_pose", "geometry_msgs/msg/PoseStamped")
        add("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped")
        add("/clicked_point", "geometry_msgs/msg/PointStamped")
        add("/markers", "visualization_msgs/msg/MarkerArray")
        add("/camera/image_raw", "sensor_msgs/msg/Image")
        add("/camera/camera_info", "sensor_msgs/msg/CameraInfo")
        add("/local_costmap/published_footprint", "geometry_msgs/msg/PolygonStamped")
        if self._maps:
            add("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
            add("/map_updates", "map_msgs/msg/OccupancyGridUpdate")
            add("/global_costmap/costmap", "nav_msgs/msg/OccupancyGrid", latched=True)
            add("/local_costmap/costmap", "nav_msgs/msg/OccupancyGrid", latched=True)
        description = load_xacro(
            SHARE / "turtlebot3_description/urdf/turtlebot3_waffle.urdf.xacro",
            resolve=lambda package: SHARE / package,
        )
        self._send("/robot_description", "std_msgs/msg/String", data=description)
        self._send("/tf_static", "tf2_msgs/msg/TFMessage", transforms=self._static_transforms())
        self.source.hooks["/goal_pose"] = self._take_goal

    # The world --------------------------------------------------------------------------------------

    def _run(self) -> None:
        due = time.monotonic()
        while not self._stopping.is_set():
            self._step()
            due += STEP_S
            self._stopping.wait(max(0.0, due - time.monotonic()))

    def _step(self) -> None:
        self.now += STEP_S
        self._steps += 1
        self.source.stamp = round(self.now * 1e9)
        self._drive()
        self.track.append((self.now, self.x, self.y))
        self.source.set_time(self.source.stamp)
        self._send("/clock", "rosgraph_msgs/msg/Clock", clock=self._stamp())
        self._send_transforms()
        if self._steps % 2 == 0:
            self._send_odometry()
        if self._steps % 3 == 0:
            self._send_scan()
        if self._steps % 10 == 1:
            self._send_plan()
        if self._steps % 50 == 1 and self._maps:
            self._send_maps()
        if self._steps % 25 == 2:
            self._send_markers()
            self._send_camera()
        if self._steps % 100 == 5:
            self._log(20, "controller_server", f"Passing x {self.x:.2f}, y {self.y:.2f}")
        if self._steps % 400 == 205:
            self._log(30, "planner_server", "Replanning took longer than the desired 20.0 Hz")

    def _drive(self) -> None:
        if self.goal is None:
            loop = 0.24 * self.now
            target = (1.1 * math.cos(loop) + 0.2, 1.0 * math.sin(loop))
            reached = False
        else:
            target = self.goal[:2]
            reached = math.hypot(target[0] - self.x, target[1] - self.y) < 0.05
        if reached and self.goal is not None:
            error = _wrap(self.goal[2] - self.yaw)
            self.speed, self.turn = 0.0, float(np.clip(3 * error, -1.5, 1.5))
            if abs(error) < 0.02:
                self.turn = 0.0
        else:
            bearing = _wrap(math.atan2(target[1] - self.y, target[0] - self.x) - self.yaw)
            distance = math.hypot(target[0] - self.x, target[1] - self.y)
            self.turn = float(np.clip(2.5 * bearing, -1.5, 1.5))
            self.speed = min(0.5, distance) * max(0.0, math.cos(bearing))
        self.yaw = _wrap(self.yaw + self.turn * STEP_S)
        self.x += self.speed * math.cos(self.yaw) * STEP_S
        self.y += self.speed * math.sin(self.yaw) * STEP_S
        steps = np.linspace(0, 1, 40)
        distort = 0.25 * np.sin(steps * math.pi)
        self._path = [
            (
                self.x + s * (target[0] - self.x) - b * (target[1] - self.y),
                self.y + s * (target[1] - self.y) + b * (target[0] - self.x),
            )
            for s, b in zip(steps, distort, strict=True)
        ]

    def _take_goal(self, payload: bytes) -> None:
        pose = decode("geometry_msgs/msg/PoseStamped", payload).pose
        yaw = 2 * math.atan2(pose.orientation.z, pose.orientation.w)
        self.goal = (pose.position.x, pose.position.y, yaw)
        self.goals.append(self.goal)
        self._log(20, "bt_navigator", f"Begin navigating to ({self.goal[0]:.2f}, {self.goal[1]:.2f})")

    # The messages -----------------------------------------------------------------------------------

    def _send(self, topic: str, type_name: str, **fields: object) -> None:
        if self.source.listener_count(topic) or self.source.keeps(topic):
            self.source.send(topic, encode(type_name, make(type_name, **fields)))

    def _stamp(self) -> object:
        seconds = math.floor(self.now)
        return make(
            "builtin_interfaces/msg/Time",
            sec=seconds,
            nanosec=round((self.now - seconds) * 1e9) % 1_000_000_000,
        )

    def _header(self, frame: str) -> object:
        return make("std_msgs/msg/Header", stamp=self._stamp(), frame_id=frame)

    def _transform(self, parent: str, child: str, x: float, y: float, z: float, quaternion: tuple) -> object:
        return make(
            "geometry_msgs/msg/TransformStamped",
            header=self._header(parent),
            child_frame_id=child,
            transform=make(
                "geometry_msgs/msg/Transform",
                translation=make("geometry_msgs/msg/Vector3", x=x, y=y, z=z),
                rotation=_quaternion(*quaternion),
            ),
        )

    def _static_transforms(self) -> list:
        level = (0.0, 0.0, 0.0, 1.0)
        return [
            self._transform("base_footprint", "base_link", 0, 0, 0.010, level),
            self._transform("base_link", "imu_link", 0.0, 0, 0.068, level),
            self._transform("base_link", "base_scan", *SCAN_MOUNT, level),
            self._transform("base_link", "camera_link", 0.064, -0.047, 0.107, level),
            self._transform("base_link", "caster_back_right_link", -0.177, -0.064, -0.004, level),
            self._transform("base_link", "caster_back_left_link", -0.177, 0.064, -0.004, level),
            self._transform("camera_link", "camera_rgb_frame", 0.005, 0.018, 0.013, level),
            self._transform("camera_rgb_frame", "camera_rgb_optical_frame", 0, 0, 0, (-0.5, 0.5, -0.5, 0.5)),
        ]

    def _send_transforms(self) -> None:
        drift = 0.05 * math.sin(0.1 * self.now)
        roll = 8 * self.now
        side = (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
        wheel = _multiply(side, (0.0, 0.0, math.sin(roll / 2), math.cos(roll / 2)))
        transforms = [
            self._transform("map", "odom", drift, 0.02, 0.0, (0, 0, 0, 1)),
            self._transform(
                "odom",
                "base_footprint",
                self.x - drift,
                self.y - 0.02,
                0.0,
                (0, 0, math.sin(self.yaw / 2), math.cos(self.yaw / 2)),
            ),
            self._transform("base_link", "wheel_left_link", 0.0, 0.144, 0.023, wheel),
            self._transform("base_link", "wheel_right_link", 0.0, -0.144, 0.023, wheel),
        ]
        self._send("/tf", "tf2_msgs/msg/TFMessage", transforms=transforms)

    def _send_scan(self) -> None:
        angles = np.linspace(-math.radians(135), math.radians(135), BEAMS)
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        x, y = self.x + cos * SCAN_MOUNT[0], self.y + sin * SCAN_MOUNT[0]
        ranges = _cast(x, y, self.yaw + angles)
        hit = ranges < 25
        ranges = ranges + np.random.default_rng(self._steps).normal(0, 0.008, BEAMS)
        if self._maps:
            self._look(x, y, self.yaw + angles, ranges)
        self._send(
            "/scan",
            "sensor_msgs/msg/LaserScan",
            header=self._header("base_scan"),
            angle_min=angles[0],
            angle_max=angles[-1],
            angle_increment=angles[1] - angles[0],
            time_increment=0.0,
            scan_time=1 / 15,
            range_min=0.05,
            range_max=25.0,
            ranges=np.where(hit, ranges, np.inf).astype(np.float32),
            intensities=np.full(BEAMS, 47, dtype=np.float32),
        )

    def _look(self, x: float, y: float, angles: np.ndarray, ranges: np.ndarray) -> None:
        share = np.linspace(0, 1, 160)[:, None]
        along = share * np.minimum(ranges + 0.06, 3.2)
        column = ((x + along * np.cos(angles) + HALF_M) / RESOLUTION).astype(int)
        row = ((y + along * np.sin(angles) + HALF_M) / RESOLUTION).astype(int)
        inside = (column >= 0) & (row >= 0) & (column < CELLS) & (row < CELLS)
        self._seen[row[inside], column[inside]] = True

    def _grid(self, topic: str, frame: str, cells: np.ndarray, x: float, y: float) -> None:
        self._send(
            topic,
            "nav_msgs/msg/OccupancyGrid",
            header=self._header(frame),
            info=make(
                "nav_msgs/msg/MapMetaData",
                map_load_time=self._stamp(),
                resolution=RESOLUTION,
                width=cells.shape[1],
                height=cells.shape[0],
                origin=_pose(x, y, 0.0),
            ),
            data=np.ascontiguousarray(cells, dtype=np.int8).ravel(),
        )

    def _send_maps(self) -> None:
        seen = np.where(self._seen, np.where(self._truth, 100, 0), -1)
        self._grid("/map", "map", seen, -HALF_M, -HALF_M)
        costs = np.where(self._seen, self._costs, -1)
        self._grid("/global_costmap/costmap", "map", costs, -HALF_M, -HALF_M)
        column, row = (round((value + HALF_M) / RESOLUTION) for value in (self.x, self.y))
        half = 30
        window = np.full((2 * half, 2 * half), 0)
        rows, columns = slice(max(0, row - half), row + half), slice(max(0, column - half), column + half)
        part = self._costs[rows, columns]
        top, left = max(0, half - row), max(0, half - column)
        window[top : top + part.shape[0], left : left + part.shape[1]] = part
        drift = 0.05 * math.sin(0.1 * self.now)
        self._grid(
            "/local_costmap/costmap",
            "odom",
            window,
            (column - half) * RESOLUTION - HALF_M - drift,
            (row - half) * RESOLUTION - HALF_M - 0.02,
        )

    def _send_odometry(self) -> None:
        covariance = np.zeros(36)
        self._send(
            "/odom",
            "nav_msgs/msg/Odometry",
            header=self._header("odom"),
            child_frame_id="base_footprint",
            pose=make(
                "geometry_msgs/msg/PoseWithCovariance",
                pose=_pose(self.x, self.y, self.yaw),
                covariance=covariance,
            ),
            twist=make(
                "geometry_msgs/msg/TwistWithCovariance",
                twist=make(
                    "geometry_msgs/msg/Twist",
                    linear=make("geometry_msgs/msg/Vector3", x=self.speed, y=0.0, z=0.0),
                    angular=make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=self.turn),
                ),
                covariance=covariance,
            ),
        )
        corners = [(0.08, 0.16), (0.08, -0.16), (-0.22, -0.16), (-0.22, 0.16)]
        point = STORE_POINT32
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        self._send(
            "/local_costmap/published_footprint",
            "geometry_msgs/msg/PolygonStamped",
            header=self._header("map"),
            polygon=make(
                "geometry_msgs/msg/Polygon",
                points=[
                    make(point, x=self.x + cos * x - sin * y, y=self.y + sin * x + cos * y, z=0.0) for x, y in corners
                ],
            ),
        )

    def _send_plan(self) -> None:
        header = self._header("map")
        poses = [make("geometry_msgs/msg/PoseStamped", header=header, pose=_pose(x, y, 0.0)) for x, y in self._path]
        self._send("/plan", "nav_msgs/msg/Path", header=header, poses=poses)

    def _send_markers(self) -> None:
        markers = [
            self._marker(3, number, x, y, 0.25, (2 * radius, 2 * radius, 0.5), (0.55, 0.6, 0.68, 0.9))
            for number, (x, y, radius) in enumerate(POSTS)
        ]
        text = self._marker(9, 100, 1.7, 1.9, 0.75, (0, 0, 0.16), (0.95, 0.95, 0.95, 1.0))
        text.text = "dock"
        self._send("/markers", "visualization_msgs/msg/MarkerArray", markers=[*markers, text])

    def _marker(self, kind: int, number: int, x: float, y: float, z: float, scale: tuple, color: tuple) -> object:
        return make(
            "visualization_msgs/msg/Marker",
            header=self._header("map"),
            ns="posts",
            id=number,
            type=kind,
            action=0,
            pose=_pose(x, y, 0.0, z),
            scale=make("geometry_msgs/msg/Vector3", x=scale[0], y=scale[1], z=scale[2]),
            color=make("std_msgs/msg/ColorRGBA", r=color[0], g=color[1], b=color[2], a=color[3]),
            lifetime=make("builtin_interfaces/msg/Duration", sec=0, nanosec=0),
            frame_locked=False,
            points=[],
            colors=[],
            texture_resource="",
            texture=make(
                "sensor_msgs/msg/CompressedImage",
                header=self._header(""),
                format="",
                data=np.empty(0, dtype=np.uint8),
            ),
            uv_coordinates=[],
            text="",
            mesh_resource="",
            mesh_file=make("visualization_msgs/msg/MeshFile", filename="", data=np.empty(0, dtype=np.uint8)),
            mesh_use_embedded_materials=False,
        )

    def _send_camera(self) -> None:
        height, width = 120, 160
        image = np.zeros((height, width, 3), dtype=np.uint8)
        image[:, :, 2] = np.linspace(200, 60, height)[:, None]
        image[height // 2 :, :, :] = 70
        center = int(width / 2 + 50 * math.sin(self.now))
        image[40:80, max(0, center - 15) : center + 15] = (226, 163, 85)
        focal, cx, cy = 130.0, width / 2, height / 2
        self._send(
            "/camera/camera_info",
            "sensor_msgs/msg/CameraInfo",
            header=self._header("camera_rgb_optical_frame"),
            height=height,
            width=width,
            distortion_model="plumb_bob",
            d=np.zeros(5),
            r=np.eye(3).ravel(),
            binning_x=0,
            binning_y=0,
            roi=make("sensor_msgs/msg/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0, do_rectify=False),
            k=np.array([focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0]),
            p=np.array([focal, 0.0, cx, 0.0, 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0]),
        )
        self._send(
            "/camera/image_raw",
            "sensor_msgs/msg/Image",
            header=self._header("camera_rgb_optical_frame"),
            height=height,
            width=width,
            encoding="rgb8",
            is_bigendian=0,
            step=3 * width,
            data=image.ravel(),
        )

    def _log(self, level: int, name: str, text: str) -> None:
        self._send(
            "/rosout",
            "rcl_interfaces/msg/Log",
            stamp=self._stamp(),
            level=level,
            name=name,
            msg=text,
            file="demo_robot.py",
            function="step",
            line=1,
        )


STORE_POINT32 = "geometry_msgs/msg/Point32"


def _pose(x: float, y: float, yaw: float, z: float = 0.0) -> object:
    return make(
        "geometry_msgs/msg/Pose",
        position=make("geometry_msgs/msg/Point", x=x, y=y, z=z),
        orientation=_quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)),
    )


def _quaternion(x: float, y: float, z: float, w: float) -> object:
    return make("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)


def _multiply(a: tuple, b: tuple) -> tuple:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def _wrap(angle: float) -> float:
    return math.remainder(angle, math.tau)


def _cast(x: float, y: float, angles: np.ndarray) -> np.ndarray:
    """Distance to walls and posts along each ray."""
    cos, sin = np.cos(angles), np.sin(angles)
    with np.errstate(divide="ignore"):
        walls = np.minimum(
            np.where(cos > 0, (WALL_M - x) / cos, (-WALL_M - x) / cos),
            np.where(sin > 0, (WALL_M - y) / sin, (-WALL_M - y) / sin),
        )
    best = walls
    for px, py, radius in POSTS:
        along = (px - x) * cos + (py - y) * sin
        across = (px - x) ** 2 + (py - y) ** 2 - along**2
        hit = (along > 0) & (across < radius**2)
        distance = along - np.sqrt(np.maximum(0, radius**2 - across))
        best = np.where(hit & (distance < best), distance, best)
    return best


def _truth() -> np.ndarray:
    at = (np.arange(CELLS) + 0.5) * RESOLUTION - HALF_M
    column, row = np.meshgrid(at, at)
    occupied = np.maximum(abs(column), abs(row)) > WALL_M - 0.5 * RESOLUTION
    for px, py, radius in POSTS:
        occupied |= np.hypot(column - px, row - py) < radius
    return occupied


def _inflate(occupied: np.ndarray) -> np.ndarray:
    from scipy.ndimage import distance_transform_edt

    distance = distance_transform_edt(~occupied) * RESOLUTION
    costs = 98 * np.exp(-6 * (distance - 0.15))
    costs = np.where(distance < 0.15, 99, np.where(distance > 0.7, 0, costs))
    return np.where(occupied, 100, costs).astype(np.int8)


def main() -> None:
    """Serve the demo robot until interrupted."""
    from daidalos.studio.assets import AssetResolver
    from daidalos.studio.server import StudioServer

    source = MemorySource()
    assets = AssetResolver(lambda package: SHARE / package if (SHARE / package).is_dir() else None)
    with DemoRobot(source), StudioServer(source, name="demo robot", assets=assets) as server:
        print(server.url, flush=True)
        threading.Event().wait()


if __name__ == "__main__":
    main()
