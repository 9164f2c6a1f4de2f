"""SDF's ``<include>``: reads the model of a URI and applies the include's changes."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from daidalos.common.pose3 import Pose
from daidalos.description.errors import DescriptionError
from daidalos.description.link import Light
from daidalos.description.markup import Element, parse_markup
from daidalos.description.sdf.actors import read_actor
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.frames import FrameGraph, RelativePose, read_pose
from daidalos.description.sdf.links import labelled, read_label, read_light, read_plugin
from daidalos.description.world import Actor, Model

NEWEST = (1, 12)
_UNVERSIONED = f'attribute "version" is missing, read as {NEWEST[0]}.{NEWEST[1]}'


@dataclass(frozen=True)
class Included:
    """Included model, and the frame that its pose refers to.

    Parameters
    ----------
    content : Model, Light, Actor or None
        None when it was not found.
    pose : RelativePose
    missing : str
        What was not found would have been called so.
    """

    content: Model | Light | Actor | None
    pose: RelativePose
    missing: str = ""


def read_include(element: Element, context: Context, read_model: Callable[[Element, Context], Model]) -> Included:
    """Read ``<include>``; its name, pose, static flag and plugins override those of the file."""
    uri = element.text_of("uri")
    if not uri:
        raise element.error("<uri> is missing or empty")
    found = context.find(uri)
    if found is None:
        missing = element.error(f"{uri} not found; {_searched(uri, context)}")
        if context.strict:
            raise missing
        context.warnings.append(f"{missing}; left out")
        named = re.sub(r"/(\d+|tip)?$", "", uri).rpartition("/")[2]
        return Included(None, read_pose(element), element.text_of("name", default=named))
    file = model_file(found, element)
    if file in context.including:
        raise element.error(f"{uri} includes itself")
    content, written = _read_file(file, context, read_model)
    pose = read_pose(element) if element.first("pose") is not None else written
    if isinstance(content, Light):
        return Included(replace(content, name=element.text_of("name", default=content.name)), pose)
    if isinstance(content, Actor):
        return Included(_cast(content, element), pose)
    model = replace(
        content,
        name=element.text_of("name", default=content.name),
        links=labelled(content.links, read_label(element)),
        static=element.flag_of("static", default=content.static),
        placement_frame=element.text_of("placement_frame", default=content.placement_frame),
        plugins=(*content.plugins, *(read_plugin(child) for child in element.all("plugin"))),
    )
    return Included(model, pose)


def resolve_missing(
    missing: Mapping[str, tuple[RelativePose, Element]], graph: FrameGraph, joints: list[Element], context: Context
) -> list[Element]:
    """Keep the frames of models that were not found, and return the joints that do not refer to one.

    Parameters
    ----------
    missing : mapping of str to (RelativePose, Element)
        Pose and ``<include>`` of each, by name.
    graph : FrameGraph
        Holds everything else in the scope but the joints.
    joints : list of Element
        The scope's ``<joint>`` elements.
    context : Context
    """
    gone = {name: place for name, place in missing.items() if name not in graph}
    for name, (pose, element) in gone.items():
        graph.add_stand_in(name, pose, element)
    merged = any(element.attribute("merge", "false") in ("true", "1") for _, element in gone.values())
    kept = []
    for joint in joints:
        ends = [joint.text_of(end) for end in ("parent", "child")]
        if any(end.partition("::")[0] in gone or (merged and end not in graph) for end in ends):
            context.warn(joint, f"left out, as is one of {' and '.join(ends)}")
        else:
            kept.append(joint)
    return kept


def model_file(found: Path, element: Element) -> Path:
    """Return the file to read: `found` itself, or the newest SDF that its ``model.config`` names."""
    if not found.is_dir():
        return found
    config = found / "model.config"
    if not config.is_file():
        config = found / "manifest.xml"
    if not config.is_file():
        if (found / "model.sdf").is_file():
            return found / "model.sdf"
        raise element.error(f"{found} holds neither model.config nor model.sdf")
    choices = parse_markup(config.read_bytes(), str(config)).all("sdf")
    if not choices:
        raise DescriptionError("<sdf> is missing, expected the name of the model's file", str(config))
    best = max(choices, key=lambda choice: _rank(read_version(choice)))
    file = found / best.text.strip()
    if not file.is_file():
        raise best.error(f"no such file {file}")
    return file


def check_version(root: Element, context: Context) -> None:
    """Warn of a document whose version is missing, malformed or newer than what is known."""
    text = root.attribute("version", "")
    newest = ".".join(map(str, NEWEST))
    if not re.fullmatch(r"\d+\.\d+", text):
        context.warn(root, f"version {text!r} is not like '{newest}', read as {newest}" if text else _UNVERSIONED)
    elif read_version(root) > NEWEST:
        context.warn(root, f"version {text} is newer than {newest}, the newest known; read as {newest}")


def read_version(element: Element) -> tuple[int, int]:
    """Return the ``version`` attribute as two numbers; the newest without one."""
    words = element.attribute("version", "").split(".")
    if len(words) < 2 or not all(word.isdigit() for word in words[:2]):
        return NEWEST
    return int(words[0]), int(words[1])


def _rank(version: tuple[int, int]) -> tuple[bool, tuple[int, int]]:
    return version <= NEWEST, version


def _read_file(
    file: Path, context: Context, read_model: Callable[[Element, Context], Model]
) -> tuple[Model | Light | Actor, RelativePose]:
    root = parse_markup(file.read_bytes(), str(file))
    if root.tag == "robot":
        from daidalos.description.gazebo import model_from_robot
        from daidalos.description.urdf import read_robot

        return model_from_robot(read_robot(root, context.packages)), RelativePose()
    inside = context.inside(file, read_version(root))
    model = root.first("model")
    if model is not None:
        return read_model(model, inside), read_pose(model)
    light = root.first("light")
    if light is not None:
        return read_light(light, Pose()), read_pose(light)
    actor = root.first("actor")
    if actor is not None:
        return read_actor(actor, inside), read_pose(actor)
    raise root.error("expected <model>, <light> or <actor>")


def _cast(actor: Actor, element: Element) -> Actor:
    """Apply the name and the plugins of an ``<include>`` to an actor."""
    name = element.text_of("name", default=actor.name)
    plugins = (*actor.model.plugins, *(read_plugin(child) for child in element.all("plugin")))
    return replace(actor, name=name, model=replace(actor.model, name=name, plugins=plugins))


def _searched(uri: str, context: Context) -> str:
    if uri.startswith(("http://", "https://")):
        return "it is not among Gazebo Fuel's downloads, nor in a folder of GZ_SIM_RESOURCE_PATH"
    if uri.startswith(("model://", "package://")):
        folders = ", ".join(str(folder) for folder in context.model_path) or "no folder"
        return f"looked in {folders} (set GZ_SIM_RESOURCE_PATH or GAZEBO_MODEL_PATH)"
    return f"looked beside {context.folder}"
