"""Contract of controllers: state interfaces in, command interfaces out, and topics, services and actions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from daidalos.control.interfaces import Interfaces, LoanedInterfaces
from daidalos.description.robot import Robot
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
        Tells whether anyone listens to one of its topics.
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


class Controller(Endpoint):
    """Controller that computes commands from states once per period.

    Names of topics, services and actions that begin with ``~/`` go below its own.

    Adding a file with a subclass to this folder adds its names; a package of the user's does the same through
    the entry point group ``daidalos.controllers``, or is named by its place.

    Parameters
    ----------
    parameters : object
        Of the class `parameters`.
    context : ControllerContext

    Attributes
    ----------
    names : tuple of str
        Class attribute: the names that it goes by in parameter files.
    parameters : type
        Class attribute: a dataclass; see `daidalos.common.parameters`.
    chainable : bool
        Class attribute: whether other controllers may command it.
    command_names, state_names : tuple of str
        The interfaces that it needs.
    references : Interfaces
        What other controllers may command, without the controller's name in front.
    exported : Interfaces
        What it tells other controllers.
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
    parameters: ClassVar[type]
    chainable: ClassVar[bool] = False

    def __init__(self, parameters: Any, context: ControllerContext) -> None:
        self.p = parameters
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
        self.p = parameters

    def assign(self, commands: LoanedInterfaces, states: LoanedInterfaces) -> None:
        """Set the interfaces, in the order of their names."""
        self.commands, self.states = commands, states

    def activate(self, now_ns: int) -> None:
        """Start controlling with the assigned interfaces."""

    def deactivate(self) -> None:
        """Stop controlling; what is written to the commands is the last."""

    def take_references(self, now_ns: int, period: float) -> None:
        """Set the references from what was received; only called while no controller commands them."""

    def update(self, now_ns: int, period: float) -> Iterable[Sample]:
        """Write commands and return the samples to publish.

        Parameters
        ----------
        now_ns : int
            [ns].
        period : float
            Since the last update [s].
        """
        raise NotImplementedError

    @property
    def services(self) -> Mapping[str, Service]:
        """Services of the controller, by name."""
        return {}

    @property
    def actions(self) -> Mapping[str, Action]:
        """Actions of the controller, by name."""
        return {}
