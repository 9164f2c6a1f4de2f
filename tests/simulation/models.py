"""Small worlds and models for the tests."""

from daidalos.description import sdf, urdf
from description.robots import SHARE, share_of

GROUND = "<include><uri>model://ground_plane</uri></include>"


def world(*parts):
    """Return a world with a ground and SDF parts."""
    return sdf.parse(f"<sdf version='1.9'><world name='w'>{GROUND}{''.join(parts)}</world></sdf>", "w.sdf")


def box(name, pose="0 0 0.5 0 0 0", size="1 1 1", static=False, mass=1.0, surface="", extra=""):
    """Return the SDF of a box with its true inertia."""
    x, y, z = (float(word) for word in size.split())
    moments = [mass / 12 * (a * a + b * b) for a, b in ((y, z), (x, z), (x, y))]
    inertia = "".join(f"<{key}>{value}</{key}>" for key, value in zip(("ixx", "iyy", "izz"), moments, strict=True))
    return (
        f"<model name='{name}'><pose>{pose}</pose><static>{str(static).lower()}</static><link name='link'>"
        f"<inertial><mass>{mass}</mass><inertia>{inertia}</inertia></inertial>"
        f"<collision name='shape'><geometry><box><size>{size}</size></box></geometry>{surface}</collision>"
        f"{extra}</link></model>"
    )


def turtlebot(name="waffle", noise=False):
    """Return a TurtleBot3, silent unless told otherwise."""
    path = SHARE / f"turtlebot3_description/urdf/turtlebot3_{name}.urdf.xacro"
    silent = {"laser_noise": "0", "odometry_noise": "0", "camera": "false"}
    return urdf.load(path, {} if noise else silent, share_of)


def arena(name="arena"):
    """Return one of our worlds."""
    return sdf.load(SHARE / f"turtlebot3_gazebo/worlds/{name}.world")
