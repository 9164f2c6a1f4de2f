"""Contracts of controllers and hardware, as ros2_control has them.

An extension is one class. Controllers are made with ``(parameters, context)``: an instance of the frozen dataclass in
their class attribute `Parameters`, and a `ControllerContext`; they turn state interfaces into command interfaces, and
have topics, services and actions. Hardware is made with ``(info, context)``: what its ``<ros2_control>`` element says,
and a `HardwareContext`. Built-in classes give their names in files in `names`; those of other packages are named by
entry points, or by their class path. Values of interfaces are SI (m, rad, m/s, rad/s, N, Nm) and scalar, each of a
joint's or sensor's own axis; times are nanoseconds, periods seconds.
"""

# ruff: noqa: B027 (most hooks of a contract do nothing unless they are overridden)

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from daidalos.control.interfaces import Interfaces, LoanedInterfaces
from daidalos.description.robot import Robot
from daidalos.description.ros2_control import HardwareInfo
from daidalos.description.world import Model
from daidalos.samples.endpoint import Endpoint
from daidalos.samples.endpoint import Subscription as Subscription
from daidalos.samples.sensors import Sample


def _always(topic: str) -> bool:
    """Return True; the default without information about subscribers."""
    return True


def _ignore(line: str) -> None:
    """Ignore a line for the user."""


@dataclass(frozen=True)
class ControllerContext:
    """Context of a controller.

    Parameters
    ----------
    name : str
    update_rate : float
        Its own [Hz]; 0 for the manager's.
    robot : Robot, Model or None
        Its description, once that is known.
    namespace : str
        Of the controller, such as ``/robot1``.
    state_names : tuple of str
        All state interfaces that the hardware has.
    has_subscribers : callable
        Returns whether one of its topics has subscribers.
    warn : callable
        Takes a line for the user.
    """

    name: str
    update_rate: float = 0.0
    robot: Robot | Model | None = None
    namespace: str = "/"
    state_names: tuple[str, ...] = ()
    has_subscribers: Callable[[str], bool] = _always
    warn: Callable[[str], None] = _ignore


@dataclass(frozen=True)
class Service:
    """Service of a controller: the class of the request and the function that answers it."""

    type: type
    answer: Callable[[Any], Any]


@dataclass(eq=False)
class Goal:
    """Goal of an action, with its callbacks.

    Parameters
    ----------
    request : object
        Of the action's class.
    feedback : callable
        Takes what there is to say on the way.
    done : callable
        Takes ``succeeded``, ``aborted`` or ``canceled``, and the result.
    """

    request: Any
    feedback: Callable[[Any], None] = field(default=lambda feedback: None)
    done: Callable[[str, Any], None] = field(default=lambda status, result: None)
    status: str = ""
    result: Any = None

    def finish(self, status: str, result: Any) -> None:
        """Finish the goal; only the first call counts."""
        if not self.status:
            self.status, self.result = status, result
            self.done(status, result)


@dataclass(frozen=True)
class Action:
    """Action of a controller.

    Parameters
    ----------
    type : type
        Of its requests.
    refuse : callable
        Returns why a request is not accepted; nothing when it is.
    start : callable
        Takes a goal whose request was accepted.
    cancel : callable
        Takes a goal that should end.
    """

    type: type
    refuse: Callable[[Any], str]
    start: Callable[[Goal], None]
    cancel: Callable[[Goal], None]


class Controller(Endpoint, ABC):
    """Controller that computes commands from states once per period.

    Names of topics, services and actions that begin with ``~/`` go below its own.

    A file with a subclass in `daidalos.control.controllers` adds its names, as the entry point group
    ``daidalos.controllers`` does for other packages.

    Parameters
    ----------
    parameters : object
        An instance of the class attribute `Parameters`.
    context : ControllerContext

    Attributes
    ----------
    names : tuple of str
        Class attribute: the names that it goes by in parameter files.
    Parameters : type
        Class attribute: a frozen dataclass; see `daidalos.common.parameters`.
    chainable : bool
        Class attribute: whether other controllers may command it.
    command_names, state_names : tuple of str
        The interfaces that it needs.
    references : Interfaces
        What other controllers may command, without the controller's name in front.
    exported : Interfaces
        State interfaces that other controllers may read.
    chained : bool
        Whether another controller commands it now.
    now_ns : int
        Time of the cycle.

    Raises
    ------
    ParameterError
        When parameters do not fit together.
    """

    names: ClassVar[tuple[str, ...]] = ()
    Parameters: ClassVar[type]
    chainable: ClassVar[bool] = False

    def __init__(self, parameters: Any, context: ControllerContext) -> None:
        self.parameters: Any = parameters
        self.context = context
        self.command_names: tuple[str, ...] = ()
        self.state_names: tuple[str, ...] = ()
        self.references = Interfaces()
        self.exported = Interfaces()
        self.chained = False
        self.now_ns = 0
        self.commands = LoanedInterfaces()
        self.states = LoanedInterfaces()
        self.configure()

    def configure(self) -> None:
        """Set the names of the interfaces, and make what the controller needs."""

    def reconfigure(self, parameters: Any) -> None:
        """Apply parameters that changed at run time; read-only ones never change."""
        self.parameters = parameters

    def select_states(self, available: Sequence[str]) -> None:
        """Choose state interfaces among those of hardware that is configured now; called before each activation."""

    def assign(self, commands: LoanedInterfaces, states: LoanedInterfaces) -> None:
        """Set the interfaces, in the order of their names."""
        self.commands, self.states = commands, states

    def activate(self, now_ns: int) -> None:
        """Start controlling with the assigned interfaces."""

    def deactivate(self) -> None:
        """Stop controlling; what is written to the commands is the last."""

    def take_references(self, now_ns: int, period: float) -> None:
        """Set the references from what was received; only called while no controller commands them."""

    @abstractmethod
    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Write commands and return the samples to publish.

        Parameters
        ----------
        now_ns : int
            [ns].
        period : float
            Since the last update [s].
        """

    @property
    def services(self) -> Mapping[str, Service]:
        """Services of the controller, by name."""
        return {}

    @property
    def actions(self) -> Mapping[str, Action]:
        """Actions of the controller, by name."""
        return {}


@dataclass(frozen=True)
class HardwareContext:
    """Context of hardware.

    Parameters
    ----------
    update_rate : float
        Of the manager [Hz].
    warn : callable
        Takes a line for the user.
    """

    update_rate: float = 100.0
    warn: Callable[[str], None] = _ignore


class Hardware(ABC):
    """Hardware of a robot or of a part of it.

    A subclass reads sensors into `states` in `read` and sends `commands` in `write`; it raises `HardwareError` where
    something fails. ``<plugin>`` names it by its class path, or by an entry point of the group ``daidalos.hardware``.

    Parameters
    ----------
    info : HardwareInfo
        What the robot's ``<ros2_control>`` element says.
    context : HardwareContext

    Attributes
    ----------
    names : tuple of str
        Class attribute: the plugins that it stands for.
    commands, states : Interfaces
        Named values, SI. Commands are NaN as long as nobody commands them.
    """

    names: ClassVar[tuple[str, ...]] = ()

    def __init__(self, info: HardwareInfo, context: HardwareContext | None = None) -> None:
        self.info = info
        self.context = context or HardwareContext()
        self.commands = Interfaces(info.command_names)
        self.states = Interfaces(info.state_names)

    def configure(self) -> None:
        """Connect with the robot; called from ``unconfigured``."""

    def cleanup(self) -> None:
        """Disconnect; called on the way back to ``unconfigured``, and at the end."""

    def activate(self) -> None:
        """Power up; commands count from now on."""

    def deactivate(self) -> None:
        """Stop motion."""

    @abstractmethod
    def read(self, now_ns: int, period: float) -> None:
        """Update `states` from the hardware.

        Parameters
        ----------
        now_ns : int
            [ns].
        period : float
            Since the last reading [s].
        """

    def write(self, now_ns: int, period: float) -> None:
        """Send `commands`; see `read`."""

    def prepare_switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Refuse, with a `HardwareError`, command interfaces that cannot be claimed or released together."""

    def switch(self, start: Sequence[str], stop: Sequence[str]) -> None:
        """Switch command interfaces; those in `stop` that are not in `start` are no longer used."""
