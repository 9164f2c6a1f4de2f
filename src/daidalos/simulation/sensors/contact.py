"""Contact sensor: contacts of a link's collisions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from daidalos.description.markup import Element
from daidalos.samples.sensors import BumperSample, ContactsSample, Sample
from daidalos.simulation.contacts import read_contacts
from daidalos.simulation.contracts import Sensor
from daidalos.simulation.instance import Instance


class ContactSensor(Sensor):
    """Sensor of the contacts of some collisions.

    Attributes
    ----------
    as_bumper : bool
        Speak as Gazebo classic's bumper does.
    """

    names = ("contact",)
    default_topic = "contact"

    def read(self, element: Element) -> None:
        """Read the names of the collisions; all of the link if none is named."""
        settings = element.first("contact") or Element("contact")
        self.collisions = frozenset(child.text.strip().rpartition("::")[2] for child in settings.all("collision"))
        self.as_bumper = False
        topic = settings.text_of("topic")
        if topic and topic != "__default_topic__":
            self.topic = topic if topic.startswith("/") else f"/{topic}"

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topic of the contacts."""
        return {self.topic: BumperSample if self.as_bumper else ContactsSample}

    def bind(self, instance: Instance) -> None:
        """Find the geoms of the collisions."""
        super().bind(instance)
        known = {info.collision for _, info in instance.build.geoms.items() if info.link == self.link_name}
        wanted = {name for name in self.collisions if name != "__default__"} or known
        # A URDF's collision is called after its link in Gazebo, however many the link has.
        matches = wanted & known or {name for name in known if any(name.startswith(w) for w in wanted)} or known
        self._mine = np.zeros(instance.physics.model.ngeom, dtype=bool)
        for geom, (model, info) in instance.physics.geoms.items():
            self._mine[geom] = model == instance.name and info.link == self.link_name and info.collision in matches

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the current contacts; the sensor's own collision is the first of each pair."""
        found = tuple(
            contact if contact.link1 == self.link_name and contact.model1 == self.instance.name else contact.swapped()
            for contact in read_contacts(self.instance.physics, self._mine)
        )
        kind = BumperSample if self.as_bumper else ContactsSample
        yield kind(now_ns, self.topic, self.frame_id, found)
