"""Contracts of planners, controllers, costmap layers and the other extensions of navigation.

Every extension is one class, made with ``(parameters, context)``: its parameters, an instance of the frozen dataclass
in its class attribute `Parameters` whose fields have the names of Nav2's parameter files, and a `NavigationContext`.
Built-in classes give their names in Nav2's parameter files in `names`; those of other packages are named by entry
points, or by their class path. Poses are (x, y, yaw) in metres and radians, velocities (x, y, yaw) in m/s and rad/s in
the robot's frame; times are seconds. An extension that cannot do its work raises an error of
`daidalos.navigation.errors`.

The contract of behaviour-tree nodes is in `daidalos.navigation.trees.node`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.errors import Location
from daidalos.common.extensions import Kind, find
from daidalos.navigation.costmap.costmap import FREE_SPACE, Bounds, Costmap, Window
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.voxels import VoxelGrid

if TYPE_CHECKING:
    from daidalos.navigation.controllers.dwb.trajectories import Trajectories
    from daidalos.navigation.controllers.mppi.rollouts import Limits, Rollouts

Command = TypeVar("Command")
T = TypeVar("T")


def _ignore(line: str) -> None:
    """Ignore a line for the user."""


def _locate_nothing(frame: str) -> None:
    """Return None: no frame is known."""


@dataclass(frozen=True)
class NavigationContext:
    """Context of an extension beside its parameters.

    Attributes
    ----------
    name : str
        Name of the extension in parameter files, such as ``FollowPath``.
    footprint : Footprint
        Outline of the robot in its base frame [m].
    frequency : float
        How often it is called while it works [Hz].
    global_frame, base_frame : str
        Frames of the costmap and of the robot.
    track_unknown_space : bool
        Whether cells of the costmap that nothing was seen of are unknown, rather than free.
    seed : int
        Of random numbers.
    warn : callable
        Called with a line for the user.
    locate : callable
        Called with the name of a frame; returns its pose (x, y, yaw) in the global frame and the age [s] of that, or
        None where it is not known.
    maker : callable or None
        Makes another extension; see `make`.
    """

    name: str = ""
    footprint: Footprint = Footprint.circle(0.1)  # noqa: RUF009 (it does not change)
    frequency: float = 20.0
    global_frame: str = "map"
    base_frame: str = "base_link"
    track_unknown_space: bool = True
    seed: int = 0
    warn: Callable[[str], None] = _ignore
    locate: Callable[[str], tuple[Array, float] | None] = _locate_nothing
    maker: Callable[[Kind[Any], str, str, str], Any] | None = None

    def make(self, kind: Kind[T], name: str, parameter: str, below: str = "") -> T:
        """Create an extension that this one uses.

        Parameters
        ----------
        kind : Kind
        name : str
            As in parameter files.
        parameter : str
            The parameter of the extension that has the name.
        below : str
            Its parameters are called ``<name>.<below>.<parameter>``; they stand beside the own where empty.

        Raises
        ------
        ExtensionError
            There is none of that name.
        """
        if self.maker is not None:
            made: T = self.maker(kind, name, parameter, below)
            return made
        found: Any = find(kind, name, asked_by=Location(name=parameter))
        return found(None, replace(self, name=below or self.name))  # type: ignore[no-any-return]


_ALONE = NavigationContext()


class NavigationExtension(ABC):  # noqa: B024 (each contract has its own methods)
    """Base of all contracts.

    Parameters
    ----------
    parameters : object, optional
        An instance of the class attribute `Parameters`; the defaults where it is left out.
    context : NavigationContext, optional

    Attributes
    ----------
    names : tuple of str
        Class attribute: names of a built-in class in parameter files.
    Parameters : type or None
        Class attribute: the frozen dataclass of its parameters; None where it has none.
    """

    names: ClassVar[tuple[str, ...]] = ()
    Parameters: ClassVar[type | None] = None

    def __init__(self, parameters: Any = None, context: NavigationContext | None = None) -> None:
        kind: Any = type(self).Parameters
        self.parameters: Any = kind() if parameters is None and kind is not None else parameters
        self.context = context or _ALONE

    def reconfigure(self, parameters: Any) -> None:
        """Use other parameters from the next call on; those that are read-only are the same.

        Raises
        ------
        ParameterError
            They cannot be used.
        """
        self.parameters = parameters


def _never() -> bool:
    return False


class GlobalPlanner(NavigationExtension):
    """Planner of a path over a costmap.

    Attributes
    ----------
    is_cancelled : callable
        Returns whether the plan is no longer wanted; long searches call it now and then and raise `PlanningCancelled`.
    """

    is_cancelled: Callable[[], bool] = staticmethod(_never)

    @abstractmethod
    def create_plan(self, costmap: Costmap, start: Array, goal: Array) -> Array:
        """Plan a path.

        Parameters
        ----------
        costmap : Costmap
            Inflated costs.
        start, goal : ndarray, shape (3,)
            Poses (x, y, yaw) in the costmap's frame.

        Returns
        -------
        ndarray, shape (n, 3)
            Poses from the start to the goal, each looking along the path, the last as the goal does.

        Raises
        ------
        PlannerError
            There is no plan; the class and the message say why.
        """


class Smoother(NavigationExtension):
    """Smoother of a path that keeps it free of obstacles."""

    @abstractmethod
    def smooth(self, path: Array, costmap: Costmap) -> Array:
        """Smooth a path.

        Parameters
        ----------
        path : ndarray, shape (n, 3)
            Poses (x, y, yaw) in the costmap's frame.
        costmap : Costmap
            Inflated costs.

        Returns
        -------
        ndarray, shape (n, 3)
            Poses with the same first and last position, each looking along the path.
        """


@dataclass(frozen=True)
class ControlInput:
    """Inputs of a controller in one cycle; poses are (x, y, yaw) in the costmap's frame.

    Attributes
    ----------
    pose : ndarray, shape (3,)
        Where the robot is.
    velocity : ndarray, shape (3,)
        Its velocity (x [m/s], y [m/s], yaw [rad/s]) in its own frame.
    path : ndarray, shape (n, 3)
        The part of the plan ahead, from the robot as far as the controller looks.
    goal : ndarray, shape (3,)
        End of the whole plan.
    distance_to_goal : float
        Length [m] of the rest of the plan.
    costmap : Costmap
        Inflated costs around the robot.
    circumscribed_cost : int
        Smallest cost at the robot's centre at which some part of it may touch an obstacle.
    xy_goal_tolerance, yaw_goal_tolerance : float
        How near [m], [rad] to the goal is near enough.
    """

    pose: Array
    velocity: Array
    path: Array
    goal: Array
    distance_to_goal: float
    costmap: Costmap
    circumscribed_cost: int = 1
    xy_goal_tolerance: float = 0.25
    yaw_goal_tolerance: float = 0.25


class Controller(NavigationExtension):
    """Controller that computes the velocity of the next cycle."""

    @property
    @abstractmethod
    def look_ahead(self) -> float:
        """Length [m] of the path that the controller uses."""

    @property
    def inversion_tolerances(self) -> tuple[float, float] | None:
        """How near [m], [rad] to a cusp of the path the robot has to come before it reverses; None for any distance."""
        return None

    @abstractmethod
    def compute_velocity_commands(self, control: ControlInput) -> Array:
        """Compute the velocity of the next cycle.

        Returns
        -------
        ndarray, shape (3,)
            Velocity (x [m/s], y [m/s], yaw [rad/s]) in the robot's frame.

        Raises
        ------
        ControllerError
            There is none.
        """

    @abstractmethod
    def set_speed_limit(self, speed_limit: float, *, percentage: bool) -> None:
        """Limit the speed to a value [m/s] or a percentage of the maximum; 0 removes the limit."""

    @abstractmethod
    def reset(self) -> None:
        """Reset the state of the last task."""

    @property
    def outputs(self) -> tuple[Output, ...]:
        """What is shown of the last cycle in the costmap's frame: paths (n, 3) as `numpy.ndarray`, and `Candidates`."""
        return ()


@dataclass(frozen=True)
class Candidates:
    """Trajectories of which a controller has chosen, to be shown.

    Attributes
    ----------
    points : ndarray, shape (n, m, 2)
        The points [m] of each.
    costs : ndarray, shape (n,)
        How good they are; the least is the best.
    """

    points: NDArray[np.floating[Any]]
    costs: NDArray[np.floating[Any]]


class GoalChecker(NavigationExtension):
    """Check of whether a goal is reached."""

    @property
    @abstractmethod
    def tolerances(self) -> tuple[float, float]:
        """Tolerances of position [m] and yaw [rad]."""

    @abstractmethod
    def is_goal_reached(self, pose: Array, goal: Array, velocity: Array) -> bool:
        """Return whether a pose (x, y, yaw) and a velocity (x, y, yaw) fulfil a goal in the same frame."""

    @abstractmethod
    def reset(self) -> None:
        """Reset for a new goal."""


class ProgressChecker(NavigationExtension):
    """Check of whether a robot makes progress."""

    @abstractmethod
    def check(self, pose: Array, now: float) -> bool:
        """Return whether the robot, at a pose (x, y, yaw) and a time [s], has moved enough recently."""

    @abstractmethod
    def reset(self) -> None:
        """Reset for a new path."""


@dataclass(frozen=True)
class Scene:
    """Inputs of critics beside the rollouts.

    Attributes
    ----------
    control : ControlInput
        State, path, goal and costmap of the cycle.
    footprint : Footprint
        Outline of the robot.
    along : ndarray, shape (n,)
        Distance [m] along the path of each of its poses.
    path_free : ndarray of bool, shape (n,)
        Whether the robot's centre may be at each pose of the path.
    furthest : int
        Pose of the path farthest along that any rollout ends near to.
    step : float
        Length of a step of the rollouts [s].
    limits : Limits
        What the robot can do, under the speed limit.
    """

    control: ControlInput
    footprint: Footprint
    along: Array
    path_free: NDArray[np.bool_]
    furthest: int
    step: float
    limits: Limits

    def next_free(self, index: int) -> int:
        """Return the index of the first free pose of the path from an index on; the last if there is none."""
        last = self.along.size - 1
        index = min(index, last)
        free = np.flatnonzero(self.path_free[index:])
        return index + int(free[0]) if free.size else last


class Critic(NavigationExtension):
    """Cost term of rollouts.

    Attributes
    ----------
    judges_contact : bool
        Whether this critic notes in `rollouts.collides` which samples touch an obstacle.
    """

    judges_contact: bool = False

    @abstractmethod
    def score(self, rollouts: Rollouts, scene: Scene) -> None:
        """Add this critic's costs to `rollouts.costs`."""


class TrajectoryValidator(NavigationExtension):
    """Check of the trajectory that the MPPI controller has chosen, before the robot drives along it."""

    @abstractmethod
    def is_valid(self, trajectory: Array, scene: Scene) -> bool:
        """Return whether the robot may drive along a trajectory.

        Parameters
        ----------
        trajectory : ndarray, shape (n, 3)
            Poses (x, y, yaw) in the costmap's frame, `scene.step` [s] apart.
        scene : Scene
        """


class TrajectoryCritic(NavigationExtension):
    """Cost term of trajectories of constant commands, of which the DWB controller takes the best."""

    def reset(self) -> None:
        """Reset the state of the last task."""

    def note(self, pose: Array, command: Array) -> None:
        """Take note of the command (x [m/s], y [m/s], yaw [rad/s]) that is given at a pose (x, y, yaw)."""

    @abstractmethod
    def score(self, trajectories: Trajectories, scene: TrajectoryScene) -> Array:
        """Return the weighted cost of each trajectory, shape (n,): not negative, infinite where it is impossible."""


@dataclass(frozen=True)
class TrajectoryScene:
    """Inputs of critics of trajectories beside these.

    Attributes
    ----------
    control : ControlInput
        State, path, goal and costmap of the cycle.
    footprint : Footprint
        Outline of the robot.
    xy_goal_tolerance : float
        How near [m] to the goal the robot has to turn to the goal's yaw.
    trans_stopped_velocity : float
        Translational speed [m/s] below which it stands.
    """

    control: ControlInput
    footprint: Footprint
    xy_goal_tolerance: float
    trans_stopped_velocity: float


@dataclass(frozen=True)
class Input:
    """Topic that a costmap layer, a behaviour or a task at a waypoint subscribes to.

    Attributes
    ----------
    topic : str
        Its topic; empty for the costmap's own ``map_topic``.
    type : type
        For a layer `OccupancyGrid`, `LaserScanData`, `CloudData` or `RangeData`; for a costmap filter `FilterInfo` or
        `FilterMask`. For a behaviour `numpy.ndarray`, for a velocity (x [m/s], y [m/s], yaw [rad/s]), or `NoneType`,
        for an empty message, as for a task at a waypoint. For such a task also `numpy.ndarray`, for an image.
    take : callable
        Called with a map; or with a scan, cloud or range, the base pose at its time in the costmap's frame, and that
        time [s]; or with a velocity and the time [s]; or with nothing; or with a function that returns an image's
        pixels, shape (height, width) or (height, width, 3) for RGB, and raises `TaskFailed` where they cannot be read.
        Called with the information about a filter's mask it returns the input of that mask, or None where the filter
        cannot use it.
    latched : bool
        Whether a map that was published before it is subscribed to is wanted (durability transient local).
    """

    topic: str
    type: type
    take: Callable[..., Input | None]
    latched: bool = True


@dataclass(frozen=True)
class SpeedLimit:
    """Limit of the robot's speed.

    Attributes
    ----------
    value : float
        Speed [m/s] or percentage of the maximum; 0 for no limit.
    percentage : bool
        Whether it is a percentage.
    """

    value: float
    percentage: bool


@dataclass(frozen=True)
class Output:
    """Topic that a costmap layer or a controller publishes on.

    Attributes
    ----------
    topic : str
        Its topic.
    type : type
        For a layer `SpeedLimit`, `bool`, or `CloudData` in the costmap's frame, whose topic stands beside those of the
        costmap; for a controller see `Controller.outputs`.
    give : callable
        Called after each update of the costmap, or each cycle of a controller if there are subscribers; returns what is
        published, or None.
    """

    topic: str
    type: type
    give: Callable[[], Any]


class Layer(NavigationExtension):
    """Source of costs; layers are combined in the order of the costmap's list.

    Attributes
    ----------
    clearable : bool
        Whether the clearing services of a costmap make this layer forget.
    """

    clearable: bool = False

    @property
    def enabled(self) -> bool:
        """Whether the layer is used: its parameter `enabled`, where it has one."""
        return bool(getattr(self.parameters, "enabled", True))

    @property
    def contained(self) -> tuple[Layer, ...]:
        """Layers that this one is made of."""
        return ()

    @property
    def voxels(self) -> VoxelGrid | None:
        """What the layer knows in space, for display; None for layers that are flat."""
        return None

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Topics that the layer subscribes to."""
        return ()

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Topics that the layer publishes on while it is enabled."""
        return ()

    def missing_input(self, now: float) -> str:
        """Return what the layer lacks at a time [s] to know the present, in words; empty where it lacks nothing."""
        return ""

    def age_of_input(self, now: float) -> float:
        """Return how old the layer's oldest input is at a time [s], as a share of what is allowed; 0 without inputs."""
        return 0.0

    @property
    def extent(self) -> Costmap | None:
        """Costmap whose size and origin the whole costmap takes over; `None` for layers without a size."""
        return None

    def match_size(self, costmap: Costmap) -> None:
        """Adapt to the changed size and origin of the costmap."""

    @abstractmethod
    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Return the bounds of the area that must be updated.

        Parameters
        ----------
        robot_pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the robot in the costmap's frame.
        now : float
            Time [s].
        bounds : Bounds
            What the layers below asked for.

        Returns
        -------
        Bounds
            The same or more.
        """

    @abstractmethod
    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Write this layer's costs into a window of the costmap, on top of the layers below."""

    def cost_at_distance(self, distance: float) -> int:
        """Return the cost that this layer gives a cell at a distance [m] from an obstacle."""
        return FREE_SPACE

    def clear(self, keep: Window, *, inside: bool) -> None:
        """Clear the inside of a window of cells, or its outside."""


@dataclass(frozen=True)
class BehaviorStep:
    """Result of one cycle.

    Attributes
    ----------
    velocity : ndarray, shape (3,)
        Velocity command (x [m/s], y [m/s], yaw [rad/s]) in the robot's frame.
    done : bool
        Whether the behaviour is done; the velocity is zero then.
    feedback : float
        What is done so far: distance [m], angle [rad]; the time left [s] of a wait.
    """

    velocity: Array
    done: bool
    feedback: float


class Behavior(NavigationExtension, Generic[Command]):
    """Motion that continues until it is done, fails or is cancelled.

    A behaviour is asked for by an action of its own name.

    Attributes
    ----------
    action : str
        Class attribute: type of the action, such as ``nav2_msgs/action/Spin``.
    feedback : str
        Class attribute: field of the action's feedback for what is done so far; empty where there is none.
    moves : bool
        Class attribute: whether it moves the robot, and so needs to know what is around it.
    """

    action: ClassVar[str]
    feedback: ClassVar[str] = ""
    moves: ClassVar[bool] = True

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Topics that the behaviour subscribes to."""
        return ()

    @property
    def period(self) -> float:
        """Period of a cycle [s]."""
        return 1.0 / self.context.frequency

    def set_footprint(self, footprint: Footprint) -> None:
        """Use another outline of the robot from the next cycle on."""
        self.context = replace(self.context, footprint=footprint)

    @classmethod
    @abstractmethod
    def command(cls, goal: Any) -> Command:
        """Return the command of an action's goal, whose fields are attributes; durations are in seconds."""

    @abstractmethod
    def start(self, command: Command, pose: Array, now: float) -> None:
        """Start.

        Parameters
        ----------
        command : Command
            How far, how fast, how long.
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the robot, in the frame of all that follow.
        now : float
            Time [s].

        Raises
        ------
        InvalidInput
            The command makes no sense.
        """

    @abstractmethod
    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Compute the velocity of the next cycle.

        Parameters
        ----------
        pose, velocity : ndarray, shape (3,)
            Pose of the robot in the costmap's frame, and its velocity in its own.
        costmap : Costmap
            Inflated costs around the robot.
        now : float
            Time [s].

        Raises
        ------
        BehaviorError
            It cannot go on: `CollisionAhead` or `TimedOut`.
        """


class WaypointTask(NavigationExtension):
    """Task that is carried out at each waypoint."""

    @property
    def inputs(self) -> tuple[Input, ...]:
        """Topics that the task subscribes to."""
        return ()

    @abstractmethod
    def start(self, index: int, pose: Array, now: float) -> None:
        """Start the task.

        Parameters
        ----------
        index : int
            Which waypoint the robot has reached, from 0.
        pose : ndarray, shape (3,)
            Pose (x, y, yaw) of the waypoint in its own frame.
        now : float
            Time [s].
        """

    @abstractmethod
    def step(self, now: float) -> bool:
        """Return whether the task is done at a time [s].

        Raises
        ------
        TaskFailed
            It cannot be done.
        """
