"""SDF's ``<model>``: reads a model and merges its nested models into it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from daidalos.common.pose3 import Pose
from daidalos.description.joint import Joint
from daidalos.description.link import Link, Plugin
from daidalos.description.markup import Element
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.frames import FrameGraph, RelativePose, read_pose
from daidalos.description.sdf.includes import read_include, resolve_missing
from daidalos.description.sdf.joints import read_joint
from daidalos.description.sdf.links import labelled, read_label, read_link, read_plugin
from daidalos.description.world import Model

ROOT = "__model__"


def read_model(element: Element, context: Context) -> Model:
    """Read a ``<model>``; its pose stays as written, to be resolved in the outer scope.

    Raises
    ------
    DescriptionError
        When something in it is wrong; names file, line and element.
    """
    return _ModelReader(element, context).model()


def place_nested(graph: FrameGraph, model: Model, pose: RelativePose, element: Element) -> None:
    """Add a model and its named elements to the frames of the outer scope."""
    if model.placement_frame not in ("", ROOT):
        if model.placement_frame not in model.frames:
            raise element.error(f"placement_frame {model.placement_frame!r} is not in the model")
        placed = model.frames[model.placement_frame]
        pose = RelativePose(pose.pose @ placed.inverse, pose.relative_to)
    graph.add(model.name, pose, graph.root, element)
    graph.add(f"{model.name}::{ROOT}", RelativePose(), model.name, element)
    for name, frame in model.frames.items():
        graph.add(f"{model.name}::{name}", RelativePose(frame), model.name, element)


def link_names(model: Model, prefix: str) -> dict[str, str]:
    """Return the names by which a scope can refer to the links of a model, its frames and the model itself.

    Parameters
    ----------
    model : Model
    prefix : str
        What stands before its links' names in the scope.
    """
    carriers = {name: name for name in model.links} | dict(model.carriers)
    named = {f"{prefix}{name}": f"{prefix}{link}" for name, link in carriers.items() if name != ROOT}
    canonical = carriers.get(ROOT, next(iter(model.links), ""))
    aliases = (model.name, f"{model.name}::{ROOT}") if canonical else ()
    return named | dict.fromkeys(aliases, f"{prefix}{canonical}")


class _ModelReader:
    def __init__(self, element: Element, context: Context) -> None:
        self._element = element
        self._context = context
        self._graph = FrameGraph(ROOT)
        self._attached: dict[str, str] = {}
        self._joint_frames: dict[str, str] = {}
        self._nested: list[tuple[Model, bool]] = []
        self._missing: dict[str, tuple[RelativePose, Element]] = {}
        self._joints: list[Element] = []

    def model(self) -> Model:
        element = self._element
        left_out = self._settle_world()
        self._read_nested()
        self._place_links_and_frames()
        links = {link.name: link for link in map(self._link, element.all("link")) if link.name not in left_out}
        joints = {joint.name: joint for joint in map(self._joint, self._joints)}
        plugins = [read_plugin(child) for child in element.all("plugin")]
        for nested, merged in self._nested:
            prefix = "" if merged else f"{nested.name}::"
            place = self._graph.pose(nested.name, element)
            links |= {prefix + n: _moved(link, prefix, place, nested.static) for n, link in nested.links.items()}
            joints |= {prefix + n: _renamed(joint, prefix, place) for n, joint in nested.joints.items()}
            plugins += [_scoped(plugin, prefix) for plugin in nested.plugins]
        _check_mimics(element, joints)
        return Model(
            name=element.name(),
            pose=read_pose(element).pose,
            links=labelled(links, read_label(element)),
            joints=joints,
            frames={name: self._graph.pose(name, element) for name in self._graph.names()},
            carriers=self._carriers(),
            static=element.flag_of("static", default=False) or _all_static(links),
            self_collide=element.flag_of("self_collide", default=False),
            wind=element.flag_of("enable_wind", default=False),
            plugins=tuple(plugins),
            placement_frame=element.attribute("placement_frame", ""),
            source=element.source,
        )

    def _read_nested(self) -> None:
        for child in self._element.all("model", "include"):
            merged = False
            if child.tag == "include":
                included = read_include(child, self._context, read_model)
                if included.missing:
                    self._missing[included.missing] = (included.pose, child)
                if not isinstance(included.content, Model):
                    continue
                model, pose = included.content, included.pose
                merged = child.attribute("merge", "false") in ("true", "1")
            else:
                model, pose = read_model(child, self._context), read_pose(child)
            self._nested.append((model, merged))
            place_nested(self._graph, model, pose, child)
            self._attached |= link_names(model, "" if merged else f"{model.name}::")
            if merged:
                for name in model.frames:
                    self._graph.add(name, RelativePose(), f"{model.name}::{name}", child)

    def _place_links_and_frames(self) -> None:
        for child in self._element.all("link"):
            self._graph.add(child.name(), read_pose(child), ROOT, child)
            self._attached[child.name()] = child.name()
        for child in self._element.all("frame"):
            attached_to = child.attribute("attached_to", "")
            self._graph.add(child.name(), read_pose(child), attached_to or ROOT, child)
            self._attached[child.name()] = attached_to or ROOT
        joints = self._element.all("joint")
        self._joints = resolve_missing(self._missing, self._graph, joints, self._context)
        for child in self._joints:
            end = child.require("child")
            name = end.text.strip() or end.text_of("link_name")
            frame = self._joint_frame(child)
            self._graph.add(frame, read_pose(child), name, child)
            self._attached[frame] = name
        first = next((name for name, target in self._attached.items() if name == target), "")
        own = [child.name() for child in self._element.all("link")]
        canonical = self._element.attribute("canonical_link", "") or (own[0] if own else first)
        if canonical and canonical not in self._attached:
            raise self._element.error(f"canonical_link {canonical!r} is not in the model")
        if canonical:
            self._attached[ROOT] = canonical

    def _joint_frame(self, element: Element) -> str:
        """Return the name of a joint's frame: the joint's, unless a link has it, as SDF below 1.7 allows."""
        name = element.name()
        if any(link.name() == name for link in self._element.all("link")):
            self._context.warn(element, f"a link is called {name!r} as well, which is what poses and joints mean")
            self._joint_frames[name] = f"{name}_joint"
        return self._joint_frames.get(name, name)

    def _settle_world(self) -> set[str]:
        """Return the links that are aliases of the world and are skipped; rename others with such a name."""
        for link in self._element.all("link"):
            if link.name() != "world":
                continue
            if link.first("inertial", "collision", "visual", "sensor", "light") is None:
                self._context.warn(link, "taken for the world")
                return {"world"}
            self._context.warn(link, "the name means the world, the link is called world_link")
            link.attributes["name"] = "world_link"
            for joint in self._element.all("joint"):
                for end in joint.all("parent", "child"):
                    end.text = end.text if end.text.strip() != "world" else "world_link"
        return set()

    def _link_of(self, name: str, element: Element) -> str:
        """Follow frames and joints to their link."""
        seen: list[str] = []
        while self._attached.get(name, "") != name:
            if name in seen:
                raise element.error(f"{name!r} is attached to itself")
            if name not in self._attached:
                known = ", ".join(link for link, target in self._attached.items() if link == target)
                raise element.error(f"there is no link {name!r}; known are {known or 'none'}")
            seen.append(name)
            name = self._attached[name]
        return name

    def _carriers(self) -> dict[str, str]:
        """Return the links of frames and joints; frames of a model without links have none."""
        carriers = {}
        for name in self._attached:
            link, steps = name, 0
            while self._attached.get(link, link) != link and steps < len(self._attached):
                link, steps = self._attached[link], steps + 1
            if link != name and self._attached.get(link) == link:
                carriers[name] = link
        return carriers

    def _link(self, element: Element) -> Link:
        name = element.name()

        def place(child: Element) -> Pose:
            pose = read_pose(child)
            if pose.relative_to and not self._graph.can_place(pose.relative_to):
                # sdformat resolves these poses only when they are asked for; Gazebo then takes them as they stand.
                self._context.warn(
                    child, f"there is no frame {pose.relative_to!r}; its pose is taken relative to the link"
                )
                return pose.pose
            return self._graph.place(pose, name, child)

        return read_link(element, self._context, self._graph.pose(name, element), place)

    def _joint(self, element: Element) -> Joint:
        own = self._joint_frames.get(element.name(), element.name())
        return read_joint(element, self._context, own, self._graph.pose, self._link_of, ROOT)


def _moved(link: Link, prefix: str, place: Pose, static: bool) -> Link:
    return replace(link, name=prefix + link.name, pose=place @ link.pose, static=static or link.static)


def _all_static(links: Mapping[str, Link]) -> bool:
    """Return whether a model consists of static nested models alone, as in worlds that wrap each ``<include>``."""
    return bool(links) and all(link.static for link in links.values())


def _renamed(joint: Joint, prefix: str, place: Pose) -> Joint:
    mimic = joint.mimic and replace(joint.mimic, joint=prefix + joint.mimic.joint)
    to_world = joint.parent == "world"
    return replace(
        joint,
        name=prefix + joint.name,
        parent="world" if to_world else prefix + joint.parent,
        child=prefix + joint.child,
        origin=place @ joint.origin if to_world else joint.origin,
        mimic=mimic,
    )


def _scoped(plugin: Plugin, prefix: str) -> Plugin:
    scope = "::".join(part for part in (prefix.removesuffix("::"), plugin.scope) if part)
    return replace(plugin, scope=scope)


def _check_mimics(element: Element, joints: dict[str, Joint]) -> None:
    for joint in joints.values():
        if joint.mimic is not None and joint.mimic.joint not in joints:
            raise element.error(f"joint {joint.name!r} mimics {joint.mimic.joint!r}, which does not exist")
