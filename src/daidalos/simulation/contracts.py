"""Contracts of sensors and plugins, which act in the simulation at their own rate.

A sensor or plugin is one class, made with ``(description, context)``: its part of the file, and a `ComponentContext`.
Those that run beside the simulation (`Sensor`, `Plugin`) are components: `prepare` extends the model before it is
compiled, `bind` looks up what is needed in the compiled model, and `update` acts. Built-in classes give the names by
which files refer to them in `names`; those of other packages are named by entry points, or by their class path.
Quantities are SI, positions and vectors are in the world's axes unless said otherwise; times are in nanoseconds of
simulated time.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.common.suggestions import hint
from daidalos.description.link import Plugin as PluginDescription
from daidalos.description.link import Sensor as SensorDescription
from daidalos.description.markup import Element
from daidalos.description.world import Model, World
from daidalos.samples.endpoint import Endpoint
from daidalos.samples.sensors import Sample
from daidalos.simulation.errors import AbsentPartError
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.topics import absolute_topic

if TYPE_CHECKING:
    from daidalos.simulation.conversion.model_build import ModelBuild
    from daidalos.simulation.instance import Instance, LinkView


@dataclass(frozen=True)
class ComponentContext:
    """Context in which a component is created.

    Parameters
    ----------
    model : Model
        Its description.
    model_name : str
        Its name in the simulation.
    namespace : str
        Relative topics go below it.
    world : World
        The description of the world around it.
    stream : callable
        Returns a new generator of its random numbers, seeded by the simulation's seed and its name.
    warn : callable
        Called with a line for the user.
    link, joint : str
        For a sensor: the link that carries it, and the joint that it sits in; empty where there is none.
    """

    model: Model
    model_name: str
    namespace: str
    world: World
    stream: Callable[[], np.random.Generator]
    warn: Callable[[str], None]
    link: str = ""
    joint: str = ""

    def require_joint(self, name: str, element: Element) -> str:
        """Return the name of a joint that moves.

        Parameters
        ----------
        name : str
            In the model.
        element : Element
            What names it.

        Raises
        ------
        AbsentPartError
            When the model has no such joint, or it can not move.
        """
        joint = self.model.joints.get(name)
        if joint is None:
            raise AbsentPartError(f"there is no joint {name!r}{hint(name, self.model.joints)}", element)
        if self.model.static:
            raise AbsentPartError(f"joint {name!r} can not move, as model {self.model.name!r} is static", element)
        if not joint.axes:
            raise AbsentPartError(f"joint {name!r} is {joint.type}, expected one with an axis", element)
        return name

    def require_link(self, name: str, element: Element) -> str:
        """Return the name of a link.

        Raises
        ------
        AbsentPartError
            When the model has no such link.
        """
        if name not in self.model.links:
            raise AbsentPartError(f"there is no link {name!r}{hint(name, self.model.links)}", element)
        return name


@dataclass(frozen=True)
class Switch:
    """Service that switches something on or off.

    Parameters
    ----------
    take : callable
        Called with on or off.
    fixed : bool or None
        What a service without an argument means; None for one that is told.
    """

    take: Callable[[bool], None]
    fixed: bool | None = None


class Component(Endpoint, ABC):
    """Sensor or plugin that is updated at its period and returns samples.

    Attributes
    ----------
    period : float
        Seconds between two updates; 0 acts in every step.
    state : object
        Everything that changes while it runs. It is copied when the simulation's state is saved and
        made anew by `start` when the simulation is reset.
    random : numpy Generator
        Its own stream.
    topic : str
        Absolute name of the topic of a component with a `sample`.
    sample : type
        Class attribute: what a component with one topic publishes; others override `publications`.
    """

    topic: str
    sample: ClassVar[type[Sample] | None] = None
    period: float = 0.0
    state: Any = None

    def __init__(self, context: ComponentContext) -> None:
        self.context = context
        self.random = context.stream()

    def start(self) -> Any:
        """Return the initial state; called after `bind` and on reset."""
        return None

    def prepare(self, build: ModelBuild) -> None:
        """Add what the component needs to the model before compilation, such as actuators."""

    def bind(self, instance: Instance) -> None:
        """Look up what the component needs in the compiled model; called again after models were added or removed."""

    @abstractmethod
    def update(self, now_ns: int) -> Iterable[Sample]:
        """Act at a simulated time [ns] and return the samples to publish."""

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Topics with the classes of their samples."""
        return {} if self.sample is None else {self.topic: self.sample}

    @property
    def switches(self) -> Mapping[str, Switch]:
        """Services of the component, by absolute name."""
        return {}


class Sensor(Component):
    """Sensor on a link.

    A subclass reads its settings in `read` and returns what it measures in `measure`. A file with such a class in
    `daidalos.simulation.sensors` adds the sensor, as the entry point group ``daidalos.sensors`` does for other
    packages.

    Parameters
    ----------
    description : daidalos.description.link.Sensor
        Its part of the file.
    context : ComponentContext

    Attributes
    ----------
    names : tuple of str
        Class attribute: the types of ``<sensor>`` that a built-in class serves.
    default_topic : str
        Class attribute: last part of the topic where the file names none.
    topic : str
        Absolute; a plugin may change it.
    frame_id : str
        The frame that samples name; the link, unless a plugin names another.
    pose : Pose
        In the link's frame.
    """

    names: ClassVar[tuple[str, ...]] = ()
    default_topic: ClassVar[str] = "data"

    def __init__(self, description: SensorDescription, context: ComponentContext) -> None:
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

    @abstractmethod
    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the measurements at a simulated time [ns]; called while the topic has subscribers."""


class LibraryPlugin(ABC):  # noqa: B024 (plugins of models and of sensors have their own methods)
    """Replacement of a Gazebo library: a `Plugin` or a `SensorPlugin`.

    A file with a subclass in `daidalos.simulation.plugins` adds the plugin, as the entry point group
    ``daidalos.plugins`` does for other packages.

    Parameters
    ----------
    description : daidalos.description.link.Plugin
        Its part of the file.
    context : ComponentContext

    Attributes
    ----------
    names : tuple of str
        Class attribute: the libraries, without ``lib`` in front and ``.so`` behind.
    unused : tuple of str
        Class attribute: parameters of those libraries that mean nothing here; any other that is not read is named
        in a warning.
    parameters : PluginParameters
        Its parameters, in ROS 1's or ROS 2's spelling.
    """

    names: ClassVar[tuple[str, ...]] = ()
    unused: ClassVar[tuple[str, ...]] = ()

    def __init__(self, description: PluginDescription, context: ComponentContext) -> None:
        self.description = description
        self.context = context
        self.parameters = PluginParameters(description, context)


class Plugin(LibraryPlugin, Component):
    """Plugin of a model."""

    def __init__(self, description: PluginDescription, context: ComponentContext) -> None:
        LibraryPlugin.__init__(self, description, context)
        Component.__init__(self, context)

    @classmethod
    def make(cls, description: PluginDescription, context: ComponentContext) -> Iterable[Component]:
        """Return the components of this plugin: itself, unless a subclass overrides this."""
        return (cls(description, context),)


class SensorPlugin(LibraryPlugin):
    """Plugin that sets a sensor's ROS topic, frame and message."""

    @abstractmethod
    def configure(self, sensor: Sensor) -> None:
        """Configure the sensor before it is used."""
