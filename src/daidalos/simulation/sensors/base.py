"""Contract of sensors."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, ClassVar

from daidalos.common.pose3 import Pose
from daidalos.description.link import Sensor as Description
from daidalos.description.markup import Element
from daidalos.samples.sensors import Sample
from daidalos.simulation.component import Component, ComponentContext
from daidalos.simulation.topics import absolute_topic

if TYPE_CHECKING:
    from daidalos.simulation.instance import Instance, LinkView


class Sensor(Component):
    """Sensor on a link.

    A subclass names the SDF types that it serves in `names`, reads its part of the description in `read` and says
    in `measure` what it sees. Adding a file with such a class to this folder adds the sensor; a package
    of the user's does the same through the entry point group ``daidalos.sensors``.

    Parameters
    ----------
    description : daidalos.description.link.Sensor
        Its part of the file.
    context : ComponentContext

    Attributes
    ----------
    topic : str
        Absolute; a plugin may change it.
    frame_id : str
        The frame that samples name; the link, unless a plugin names another.
    pose : Pose
        In the link.
    """

    names: ClassVar[tuple[str, ...]] = ()
    default_topic: ClassVar[str] = "data"

    def __init__(self, description: Description, context: ComponentContext) -> None:
        super().__init__(context)
        self.name = description.name
        self.link_name = link = context.link
        self.joint_name = context.joint
        self.pose: Pose = description.pose
        self.period = 1.0 / description.update_rate if description.update_rate > 0 else 0.0
        self.frame_id = description.element.text_of(
            "gz_frame_id", "ignition_frame_id", default=link.rpartition("::")[2]
        )
        scope = f"{context.model_name}/{link.replace('::', '/')}/{description.name}"
        topic = description.topic or f"{scope}/{self.default_topic}"
        self.topic = absolute_topic(topic, context.namespace)
        self.read(description.element)

    def read(self, element: Element) -> None:
        """Read the settings of this type of sensor from its element."""

    def bind(self, instance: Instance) -> None:
        """Find the link of the sensor."""
        self.instance = instance
        self.link: LinkView = instance.link(self.link_name)

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return measurements if the topic has subscribers."""
        return self.measure(now_ns) if self.instance.has_subscribers(self.topic) else ()

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the current measurements."""
        raise NotImplementedError
