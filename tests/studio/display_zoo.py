"""One message for every kind of display, in the frame map: what the page must be able to draw."""

import math
from pathlib import Path

import numpy as np

from .memory_source import MemorySource, encode, make

CLOUD_POINTS = 4000
MESH = """solid wedge
facet normal 0 0 1
outer loop
vertex 0 0 0.2
vertex 0.4 0 0
vertex 0.2 0.4 0
endloop
endfacet
endsolid wedge
"""
ROBOT = """<robot name="zoo">
  <material name="blue"><color rgba="0.2 0.4 0.9 1"/></material>
  <link name="base_link">
    <visual><geometry><box size="0.5 0.3 0.1"/></geometry><material name="blue"/></visual>
    <visual><origin xyz="0 0 0.1"/><geometry><cylinder radius="0.1" length="0.2"/></geometry></visual>
    <visual><origin xyz="0.2 0 0.1"/><geometry><sphere radius="0.06"/></geometry></visual>
    <visual><origin xyz="-0.2 0 0.1"/><geometry><mesh filename="package://zoo/wedge.stl"/></geometry></visual>
    <collision><geometry><box size="0.5 0.3 0.3"/></geometry></collision>
  </link>
</robot>"""


def fill(source: MemorySource, share: Path) -> None:
    """Advertise a latched topic of each kind and send its message; the robot's mesh goes to a folder."""
    (share / "wedge.stl").write_text(MESH)
    for topic, type_name, message in _messages():
        source.add_topic(topic, type_name, latched=True)
        source.send(topic, encode(type_name, message))


def _messages():
    yield "/tf_static", "tf2_msgs/msg/TFMessage", make("tf2_msgs/msg/TFMessage", transforms=[_transform()])
    yield "/robot_description", "std_msgs/msg/String", make("std_msgs/msg/String", data=ROBOT)
    yield "/cloud", "sensor_msgs/msg/PointCloud2", _cloud()
    yield "/particles", "geometry_msgs/msg/PoseArray", _particles()
    yield "/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped", _estimate()
    yield "/odom", "nav_msgs/msg/Odometry", _odometry()
    yield "/path", "nav_msgs/msg/Path", _path()
    yield "/polygon", "geometry_msgs/msg/PolygonStamped", _polygon()
    yield "/point", "geometry_msgs/msg/PointStamped", _point()
    yield (
        "/goal_pose",
        "geometry_msgs/msg/PoseStamped",
        make("geometry_msgs/msg/PoseStamped", header=_header(), pose=_pose(-1.5, -1.5, 0.8)),
    )
    yield "/map", "nav_msgs/msg/OccupancyGrid", _grid()
    yield "/marker", "visualization_msgs/msg/Marker", _marker(1, 99, -2.5, 0, color=(0.3, 0.8, 0.5, 1))
    markers = [*_marker_zoo()]
    yield "/markers", "visualization_msgs/msg/MarkerArray", make("visualization_msgs/msg/MarkerArray", markers=markers)


def _time(seconds: float = 0.0):
    return make("builtin_interfaces/msg/Time", sec=int(seconds), nanosec=0)


def _header(frame: str = "map"):
    return make("std_msgs/msg/Header", stamp=_time(), frame_id=frame)


def _vector(x, y, z):
    return make("geometry_msgs/msg/Vector3", x=float(x), y=float(y), z=float(z))


def _place(x, y, z=0.0):
    return make("geometry_msgs/msg/Point", x=float(x), y=float(y), z=float(z))


def _pose(x, y, yaw, z=0.0):
    turn = make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(yaw / 2), w=math.cos(yaw / 2))
    return make("geometry_msgs/msg/Pose", position=_place(x, y, z), orientation=turn)


def _transform():
    return make(
        "geometry_msgs/msg/TransformStamped",
        header=_header(),
        child_frame_id="base_link",
        transform=make(
            "geometry_msgs/msg/Transform",
            translation=_vector(1, 0, 0.2),
            rotation=make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.3, w=0.95),
        ),
    )


def _cloud():
    turn = np.linspace(0, 40 * math.pi, CLOUD_POINTS)
    height = np.linspace(0, 1.2, CLOUD_POINTS)
    points = np.zeros(
        CLOUD_POINTS, dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4"), ("intensity", "<f4")]
    )
    points["x"] = 2.4 + (0.7 - 0.4 * height) * np.cos(turn)
    points["y"] = 1.6 + (0.7 - 0.4 * height) * np.sin(turn)
    points["z"] = height
    points["rgb"] = (np.linspace(0, 255, CLOUD_POINTS).astype(np.uint32) << 16) + 0x80
    points["intensity"] = turn
    kinds = {"x": 7, "y": 7, "z": 7, "rgb": 6, "intensity": 7}
    fields = [
        make("sensor_msgs/msg/PointField", name=name, offset=4 * i, datatype=kind, count=1)
        for i, (name, kind) in enumerate(kinds.items())
    ]
    return make(
        "sensor_msgs/msg/PointCloud2",
        header=_header(),
        height=1,
        width=CLOUD_POINTS,
        fields=fields,
        is_bigendian=False,
        point_step=20,
        row_step=20 * CLOUD_POINTS,
        data=np.frombuffer(points.tobytes(), dtype=np.uint8),
        is_dense=True,
    )


def _particles():
    random = np.random.default_rng(3)
    poses = [_pose(*random.normal((-1.5, 1.5), 0.3), random.normal(0.5, 0.4)) for _ in range(300)]
    return make("geometry_msgs/msg/PoseArray", header=_header(), poses=poses)


def _estimate():
    covariance = np.zeros(36)
    covariance[[0, 1, 6, 7, 35]] = 0.16, 0.05, 0.05, 0.04, 0.05
    pose = make("geometry_msgs/msg/PoseWithCovariance", pose=_pose(0, 2, -0.6), covariance=covariance)
    return make("geometry_msgs/msg/PoseWithCovarianceStamped", header=_header(), pose=pose)


def _odometry():
    still = make("geometry_msgs/msg/Twist", linear=_vector(0, 0, 0), angular=_vector(0, 0, 0))
    return make(
        "nav_msgs/msg/Odometry",
        header=_header(),
        child_frame_id="base_link",
        pose=make("geometry_msgs/msg/PoseWithCovariance", pose=_pose(1, 0, 0.6), covariance=np.zeros(36)),
        twist=make("geometry_msgs/msg/TwistWithCovariance", twist=still, covariance=np.zeros(36)),
    )


def _path():
    along = np.linspace(-2, 2, 60)
    poses = [
        make("geometry_msgs/msg/PoseStamped", header=_header(), pose=_pose(x, -0.8 + 0.3 * math.sin(3 * x), 0))
        for x in along
    ]
    return make("nav_msgs/msg/Path", header=_header(), poses=poses)


def _polygon():
    corners = [
        make("geometry_msgs/msg/Point32", x=0.5 * math.cos(a), y=0.5 * math.sin(a), z=0.0)
        for a in np.linspace(0, math.tau, 6, endpoint=False)
    ]
    polygon = make("geometry_msgs/msg/Polygon", points=corners)
    return make("geometry_msgs/msg/PolygonStamped", header=_header(), polygon=polygon)


def _point():
    return make("geometry_msgs/msg/PointStamped", header=_header(), point=_place(-0.5, 0.5, 0.3))


def _grid():
    cells = np.zeros((80, 80), dtype=np.int8)
    cells[0], cells[-1], cells[:, 0], cells[:, -1] = 100, 100, 100, 100
    cells[60:, 60:] = -1
    cells[10:20, 10:70] = np.linspace(0, 100, 60).astype(np.int8)
    info = make(
        "nav_msgs/msg/MapMetaData",
        map_load_time=_time(),
        resolution=0.1,
        width=80,
        height=80,
        origin=_pose(-4, -4, 0),
    )
    return make("nav_msgs/msg/OccupancyGrid", header=_header(), info=info, data=cells.ravel())


def _marker_zoo():
    shade = (0.35, 0.65, 0.95, 1.0)
    for kind in (0, 1, 2, 3):
        yield _marker(kind, kind, -2.5 + 0.7 * kind, -2.6, scale=(0.5, 0.2, 0.2), color=shade)
    zigzag = [_place(0.15 * i, 0.2 * (i % 2), 0.1) for i in range(8)]
    colors = [make("std_msgs/msg/ColorRGBA", r=i / 7, g=0.4, b=1 - i / 7, a=1.0) for i in range(8)]
    for kind in (4, 5, 6, 7, 8):
        yield _marker(kind, kind, -2.5 + 1.3 * (kind - 4), -3.3, scale=(0.06, 0.06, 0.06), points=zigzag, colors=colors)
    yield _marker(9, 9, 0.5, -2.4, scale=(0, 0, 0.25), text="text")
    corners = [_place(0, 0), _place(0.6, 0), _place(0.3, 0.5, 0.3)]
    yield _marker(11, 11, 1.2, -2.6, points=corners, colors=colors[:1] + colors[3:4] + colors[7:8])
    ends = [_place(0, 0, 0.1), _place(0.5, 0.3, 0.5)]
    yield _marker(0, 12, 2.2, -2.6, scale=(0.05, 0.1, 0), points=ends, color=(0.95, 0.6, 0.2, 1))


def _marker(kind, number, x, y, *, scale=(0.3, 0.3, 0.3), color=(0.9, 0.5, 0.3, 1.0), points=(), colors=(), text=""):
    nothing = np.empty(0, dtype=np.uint8)
    r, g, b, a = color
    return make(
        "visualization_msgs/msg/Marker",
        header=_header(),
        ns="zoo",
        id=number,
        type=kind,
        action=0,
        pose=_pose(x, y, 0.0, 0.15),
        scale=_vector(*(scale if kind != 11 else (1, 1, 1))),
        color=make("std_msgs/msg/ColorRGBA", r=float(r), g=float(g), b=float(b), a=float(a)),
        lifetime=make("builtin_interfaces/msg/Duration", sec=0, nanosec=0),
        frame_locked=False,
        points=list(points),
        colors=list(colors),
        texture_resource="",
        texture=make("sensor_msgs/msg/CompressedImage", header=_header(""), format="", data=nothing),
        uv_coordinates=[],
        text=text,
        mesh_resource="",
        mesh_file=make("visualization_msgs/msg/MeshFile", filename="", data=nothing),
        mesh_use_embedded_materials=False,
    )
