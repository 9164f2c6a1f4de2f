"""Reader of worlds and entities, and of a world's speed and topics."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from daidalos.description.world import Physics
from daidalos.nodes.packages import package_share
from daidalos.simulation.libraries import library_name

if TYPE_CHECKING:
    from daidalos.description.robot import Robot
    from daidalos.description.world import Model, World

EMPTY_WORLD = """<sdf version="1.6"><world name="default">
<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
</world></sdf>"""


def read_entity_file(path: Path) -> Robot | Model:
    """Read a URDF, xacro or SDF file, or a model's folder.

    Raises
    ------
    DescriptionError, OSError, UnicodeDecodeError
    """
    from daidalos.description.markup import Element
    from daidalos.description.sdf.includes import model_file
    from daidalos.description.xacro import load_xacro

    file = model_file(path, Element("entity", source=str(path)))
    is_xacro = file.suffix == ".xacro"
    text = load_xacro(file, resolve=package_share) if is_xacro else file.read_text(encoding="utf-8")
    return read_entity(text, str(file))


def read_entity(text: str, source: str = "the entity's description") -> Robot | Model:
    """Read a URDF or SDF document; relative addresses in SDF start at the folder of `source`.

    Raises
    ------
    DescriptionError
    """
    from daidalos.description import sdf, urdf

    if "<robot" in text.lstrip()[:2000]:
        return urdf.parse(text, source, package_share)
    return sdf.parse_model(text, source, package_share)


def read_world(path: Path | None, text: str = "") -> World:
    """Read a world from a file or a document; without either one with a ground and a sun.

    Raises
    ------
    DescriptionError
    """
    from daidalos.description import sdf

    if path is not None:
        return sdf.load(path, resolve=package_share)
    return sdf.parse(text or EMPTY_WORLD, "the world's description" if text else "empty world", package_share)


def wanted_speed(physics: Physics) -> float:
    """Return the simulated seconds in a second that a world asks for; 0 is as fast as possible.

    Gazebo classic multiplies its update rate with the step, gz names the factor: whichever differs from
    its default counts.
    """
    if physics.real_time_update_rate != Physics().real_time_update_rate:
        return physics.real_time_update_rate * physics.max_step_size
    return physics.real_time_factor


def state_namespaces(world: World) -> tuple[str, ...]:
    """Return the namespaces of states: the root, ``/gazebo``, and that of the world's state plugin."""
    found = ["", "/gazebo"]
    for plugin in world.plugins:
        if library_name(plugin.filename) == "gazebo_ros_state":
            ros = plugin.element.first("ros")
            namespace = "" if ros is None else ros.text_of("namespace").strip("/")
            found.append(f"/{namespace}" if namespace else "")
    return tuple(dict.fromkeys(found))
