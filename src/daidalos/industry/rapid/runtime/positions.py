"""Predefined functions on positions, orientations and poses."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from daidalos.industry.rapid.runtime import poses
from daidalos.industry.rapid.runtime.registry import routine
from daidalos.industry.rapid.runtime.robot import wobj_pose

if TYPE_CHECKING:
    from daidalos.industry.rapid.runtime.task import Task

Target = list[Any]
TOOL0: list[Any] = [
    True,
    [[0.0] * 3, [1.0, 0.0, 0.0, 0.0]],
    [0.001, [0.0, 0.0, 0.001], [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0],
]
WOBJ0: list[Any] = [False, True, "", [[0.0] * 3, [1.0, 0.0, 0.0, 0.0]], [[0.0] * 3, [1.0, 0.0, 0.0, 0.0]]]


@routine("Offs")
def offset(task: Task, point_: Target, xoffset_: float, yoffset_: float, zoffset_: float) -> Target:
    """Return a target moved in the work object's frame."""
    x, y, z = point_[0]
    return [[x + xoffset_, y + yoffset_, z + zoffset_], point_[1][:], point_[2][:], point_[3][:]]


@routine("RelTool")
def relative_to_tool(
    task: Task,
    point_: Target,
    dx_: float,
    dy_: float,
    dz_: float,
    rx_: float | None = None,
    ry_: float | None = None,
    rz_: float | None = None,
) -> Target:
    """Return a target moved and turned in the tool's frame; turned about x first, then the new y, then the new z."""
    turned = [1.0, 0.0, 0.0, 0.0]
    for axis, angle in enumerate((rx_, ry_, rz_), 1):
        if angle:
            half = math.radians(angle) / 2
            q = [math.cos(half), 0.0, 0.0, 0.0]
            q[axis] = math.sin(half)
            turned = poses.quaternion_product(turned, q)
    moved = poses.pose_product([point_[0], point_[1]], [[dx_, dy_, dz_], turned])
    return [moved[0], moved[1], point_[2][:], point_[3][:]]


@routine("PoseMult")
def multiply(task: Task, pose1_: poses.Pose, pose2_: poses.Pose) -> poses.Pose:
    """Return the product of two poses."""
    return poses.pose_product(pose1_, pose2_)


@routine("PoseInv")
def invert(task: Task, pose_: poses.Pose) -> poses.Pose:
    """Return the inverse of a pose."""
    return poses.pose_inverse(pose_)


@routine("PoseVect")
def transform(task: Task, pose_: poses.Pose, pos_: poses.Vector) -> poses.Vector:
    """Return a position, given in the frame of a pose, in that around it."""
    return [a + b for a, b in zip(pose_[0], poses.rotate(pose_[1], pos_), strict=True)]


@routine("NOrient")
def normalize(task: Task, rotation_: poses.Quaternion) -> poses.Quaternion:
    """Return an orientation of length 1."""
    return poses.normalized(rotation_)


@routine("OrientZYX")
def orient_zyx(task: Task, zangle_: float, yangle_: float, xangle_: float) -> poses.Quaternion:
    """Return the orientation of three angles."""
    return poses.orientation_from_zyx(zangle_, yangle_, xangle_)


@routine("EulerZYX")
def euler(task: Task, rotation_: poses.Quaternion, x_: Any = None, y_: Any = None, z_: Any = None) -> float:
    """Return one of the three angles of an orientation."""
    angles = poses.euler_zyx(poses.normalized(rotation_))
    return angles[2] if x_ else angles[1] if y_ else angles[0]


@routine("Distance")
def distance(task: Task, point1_: poses.Vector, point2_: poses.Vector) -> float:
    """Return the distance of two positions."""
    return math.dist(point1_, point2_)


@routine("VectMagn")
def magnitude(task: Task, vector_: poses.Vector) -> float:
    """Return the length of a vector."""
    return math.hypot(*vector_)


@routine("DotProd")
def dot_product(task: Task, vector1_: poses.Vector, vector2_: poses.Vector) -> float:
    """Return the dot product."""
    return sum(a * b for a, b in zip(vector1_, vector2_, strict=True))


@routine("CrossProd")
def cross_product(task: Task, pos1_: poses.Vector, pos2_: poses.Vector) -> poses.Vector:
    """Return the cross product."""
    return poses.cross(pos1_, pos2_)


@routine("DefFrame")
def define_frame(
    task: Task, newp1_: Target, newp2_: Target, newp3_: Target, origin_: float | None = None
) -> poses.Pose:
    """Return the frame of three points; its origin is the first, or with 2 the second, or with 3 the third's foot."""
    p1, p2, p3 = newp1_[0], newp2_[0], newp3_[0]
    frame = poses.frame_of_points(p1, p2, p3)
    if origin_ == 2.0:
        return [list(p2), frame[1]]
    if origin_ == 3.0:
        x = poses.rotate(frame[1], [1.0, 0.0, 0.0])
        along = sum((c - a) * b for a, b, c in zip(p1, x, p3, strict=True))
        foot = [a + along * b for a, b in zip(p1, x, strict=True)]
        return [foot, poses.frame_of_points(foot, [a + b for a, b in zip(foot, x, strict=True)], p3)[1]]
    return frame


@routine("DefDFrame")
def define_displacement(
    task: Task, oldp1_: Target, oldp2_: Target, oldp3_: Target, newp1_: Target, newp2_: Target, newp3_: Target
) -> poses.Pose:
    """Return the displacement from three points to three others."""
    old = poses.frame_of_points(oldp1_[0], oldp2_[0], oldp3_[0])
    new = poses.frame_of_points(newp1_[0], newp2_[0], newp3_[0])
    return poses.pose_product(new, poses.pose_inverse(old))


@routine("MirPos")
def mirrored(task: Task, point_: Target, mirplane_: list[Any], wobj_: Any = None, miry_: Any = None) -> Target:
    """Return a target mirrored in a work object's xy plane; the tool's x axis is mirrored too, or with MirY its y."""
    plane, own = wobj_pose(mirplane_), wobj_pose(wobj_ or WOBJ0)
    to_plane = poses.pose_product(poses.pose_inverse(plane), own)
    seen = poses.pose_product(to_plane, [point_[0], point_[1]])
    axes = [poses.rotate(seen[1], axis) for axis in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])]
    x, y, z = ([a, b, -c] for a, b, c in axes)
    if miry_:
        x = poses.cross(y, z)
    else:
        y = poses.cross(z, x)
    image = [[seen[0][0], seen[0][1], -seen[0][2]], poses.quaternion_of_axes(x, y, z)]
    back = poses.pose_product(poses.pose_inverse(to_plane), image)
    return [back[0], back[1], point_[2][:], point_[3][:]]


@routine("CRobT")
def current_target(
    task: Task, taskref_: Any = None, taskname_: Any = None, tool_: Any = None, wobj_: Any = None
) -> Target:
    """Return where the robot is."""
    return task.robot.robtarget(tool_ or task.settings.get("tool", TOOL0), wobj_ or task.settings.get("wobj", WOBJ0))


@routine("CPos")
def current_position(task: Task, tool_: Any = None, wobj_: Any = None) -> poses.Vector:
    """Return the position of the tool."""
    position: poses.Vector = current_target(task, tool_=tool_, wobj_=wobj_)[0]
    return position


@routine("CJointT")
def current_joints(task: Task, taskref_: Any = None, taskname_: Any = None) -> Target:
    """Return where the joints are."""
    return task.robot.jointtarget()


@routine("CTool")
def current_tool(task: Task, taskref_: Any = None, taskname_: Any = None) -> list[Any]:
    """Return the tool of the latest movement."""
    tool: list[Any] = task.settings.get("tool", TOOL0)
    return tool


@routine("CWObj")
def current_wobj(task: Task, taskref_: Any = None, taskname_: Any = None) -> list[Any]:
    """Return the work object of the latest movement."""
    wobj: list[Any] = task.settings.get("wobj", WOBJ0)
    return wobj
