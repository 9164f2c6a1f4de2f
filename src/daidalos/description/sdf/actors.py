"""SDF's ``<actor>``: an animated figure that follows a script."""

from __future__ import annotations

from daidalos.common.pose3 import Pose
from daidalos.description.geometry import Mesh
from daidalos.description.link import Link, Visual
from daidalos.description.markup import Element
from daidalos.description.sdf.context import Context
from daidalos.description.sdf.frames import read_pose
from daidalos.description.sdf.links import read_link, read_plugin
from daidalos.description.world import Actor, Model, Waypoint

SKIN = "skin"
"""Name of the link that shows an actor's skin."""


def read_actor(element: Element, context: Context) -> Actor:
    """Read an ``<actor>``; its pose is as written, for the world to resolve.

    Its skin becomes the visual of a link of its own. Animations of the skin are not played: the figure
    keeps the pose of its mesh while it moves.
    """
    name = element.name()
    script = element.first("script") or Element("script")
    links = {link.name: link for link in (_skin(element, context), *_links(element, context)) if link is not None}
    return Actor(
        name=name,
        model=Model(
            name=name,
            links=links,
            static=True,
            scripted=True,
            plugins=tuple(read_plugin(child) for child in element.all("plugin")),
            source=element.source,
        ),
        pose=read_pose(element).pose,
        waypoints=_waypoints(script),
        loop=script.flag_of("loop", default=True),
        delay_start=script.number_of("delay_start", default=0.0),
        auto_start=script.flag_of("auto_start", default=True),
        skin=(element.first("skin") or Element("skin")).text_of("filename"),
    )


def _skin(element: Element, context: Context) -> Link | None:
    skin = element.first("skin")
    uri = "" if skin is None else skin.text_of("filename")
    if skin is None or not uri:
        return None
    scale = skin.number_of("scale", default=1.0)
    mesh = Mesh(uri, context.find(uri), (scale, scale, scale), where=skin.where)
    return Link(name=SKIN, visuals=(Visual(mesh, name=SKIN),), where=skin.where)


def _links(element: Element, context: Context) -> list[Link]:
    def place(child: Element) -> Pose:
        return read_pose(child).pose

    return [read_link(child, context, read_pose(child).pose, place) for child in element.all("link")]


def _waypoints(script: Element) -> tuple[Waypoint, ...]:
    """Return the waypoints of all trajectories, one trajectory after the other."""
    points: list[Waypoint] = []
    for trajectory in script.all("trajectory"):
        start = points[-1].time if points else 0.0
        points += [
            Waypoint(start + waypoint.require("time").number(), read_pose(waypoint).pose)
            for waypoint in trajectory.all("waypoint")
        ]
    return tuple(sorted(points, key=lambda point: point.time))
