"""Node of the controller manager: its services, and the nodes of its controllers."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from daidalos.common.errors import UserError
from daidalos.common.parameters import ParameterError, Parameters, group, parameter
from daidalos.control.component import INACTIVE, UNCONFIGURED
from daidalos.control.contracts import ControllerContext, Hardware
from daidalos.control.errors import ControlError
from daidalos.control.manager import ControllerManager
from daidalos.control.switching import Strictness
from daidalos.description.robot import Robot
from daidalos.description.world import Model
from daidalos.nodes.controller_manager._controller_node import ControllerNode
from daidalos.nodes.controller_manager._diagnostics import start_diagnostics
from daidalos.nodes.controller_manager._listing_services import ListingServices
from daidalos.nodes.controller_manager._reports import (
    activity_message,
    component_message,
)
from daidalos.nodes.parameters import declare, declare_given, declare_one, typed_value
from daidalos.samples.sensors import Sample

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.RELIABLE)


@dataclass(frozen=True)
class InitialStateParameters(Parameters):
    """Hardware components that are not active at first."""

    unconfigured: tuple[str, ...] = parameter((), "Hardware components that begin unconfigured.")
    inactive: tuple[str, ...] = parameter((), "Hardware components that begin inactive.")


@dataclass(frozen=True)
class ControllerManagerParameters(Parameters):
    """Parameters of the controller manager.

    Those of each controller are ``<controller>.type``, its class; ``<controller>.params_file``, files with its
    parameters; ``<controller>.fallback_controllers``, started when it fails; ``<controller>.node_options_args``,
    arguments of its node. They may be set until it is loaded.
    """

    update_rate: int = parameter(100, "Rate of the control cycle.", unit="Hz", above=0)
    enforce_command_limits: bool = parameter(True, "Whether commands are kept within the limits of the joints.")
    hardware_components_initial_state: InitialStateParameters = group(InitialStateParameters)
    robot_description: str = parameter("", "Description of the robot; from the topic where empty.")


class ControllerManagerNode(Node):
    """Node that offers a manager's services, under ROS's names.

    Parameters
    ----------
    node_name : str
    controller_arguments : list of str
        ROS arguments for all its controllers.
    **kwargs
        Of `Node`.
    """

    def __init__(
        self, node_name: str = "controller_manager", controller_arguments: list[str] | None = None, **kwargs: Any
    ) -> None:
        super().__init__(node_name, allow_undeclared_parameters=True, **kwargs)
        self._controller_arguments = controller_arguments or []
        self._use_global_arguments = bool(kwargs.get("use_global_arguments", True))
        try:
            self.settings = declare(self, ControllerManagerParameters)
        except ParameterError:
            super().destroy_node()
            raise
        declare_given(self)
        self.update_rate = float(self.settings.update_rate)
        self.lock = threading.RLock()
        self.manager: ControllerManager | None = None
        self._nodes: dict[str, ControllerNode] = {}
        self._robot: Robot | Model | None = None
        self._activity: Any = None

    def start(self, robot: Robot | Model | None, hardware: Iterable[Hardware]) -> None:
        """Start hardware, and offer the services."""
        from controller_manager_msgs.msg import ControllerManagerActivity

        self._robot = robot
        self.manager = ControllerManager(
            hardware,
            self.update_rate,
            self._initial_states(),
            self.settings.enforce_command_limits,
            self.warn,
        )
        for component in self.manager.components.values():
            self.get_logger().info(f"hardware '{component.name}' is {component.state}")
        self._activity = self.create_publisher(ControllerManagerActivity, "~/activity", _LATCHED)
        self._create_services()
        self._publish_activity()
        start_diagnostics(self, self.manager, self.lock)

    def warn(self, line: str) -> None:
        """Log a line for the user."""
        self.get_logger().warning(line)

    def _initial_states(self) -> dict[str, str]:
        first = self.settings.hardware_components_initial_state
        return dict.fromkeys(first.unconfigured, UNCONFIGURED) | dict.fromkeys(first.inactive, INACTIVE)

    # Control loop, called by the owner of the clock.

    def cycle(self, now_ns: int) -> list[tuple[str, Sample]]:
        """Run all controllers once; return what there is to publish."""
        if self.manager is None:
            return []
        with self.lock:
            for node in self._nodes.values():
                node.cancel_requested()
            before = self._states()
            said = self.manager.update(now_ns)
            if self._states() != before:  # something failed
                self._publish_activity()
            return said

    def publish(self, said: Iterable[tuple[str, Sample]]) -> None:
        """Publish what controllers said."""
        for name, sample in said:
            node = self._nodes.get(name)
            if node is not None:
                node.publish(sample)

    def _states(self) -> list[str]:
        assert self.manager is not None
        controllers = [one.state for one in self.manager.controllers.values()]
        return [*controllers, *(one.state for one in self.manager.components.values())]

    def destroy_node(self) -> None:
        """Stop everything and leave the graph."""
        with self.lock:
            if self.manager is not None:
                self.manager.shutdown()
            nodes, self._nodes = self._nodes, {}
        for node in nodes.values():
            node.destroy_node()
        super().destroy_node()

    # Services

    def _create_services(self) -> None:
        from controller_manager_msgs import srv

        group = MutuallyExclusiveCallbackGroup()
        for kind, name, answer in (
            (srv.LoadController, "load_controller", self._changing(self._load)),
            (srv.ConfigureController, "configure_controller", self._changing(self._configure)),
            (srv.CleanupController, "cleanup_controller", self._changing(self._cleanup)),
            (srv.UnloadController, "unload_controller", self._changing(self._unload)),
            (srv.SwitchController, "switch_controller", self._changing(self._switch)),
            (srv.ReloadControllerLibraries, "reload_controller_libraries", self._changing(self._reload)),
            (srv.SetHardwareComponentState, "set_hardware_component_state", self._changing(self._set_component)),
        ):
            self.create_service(kind, f"~/{name}", answer, callback_group=group)
        ListingServices(self, self._running, self.lock, group)

    def _changing(self, work: Callable[[Any, Any], None]) -> Callable[[Any, Any], Any]:
        """Return a service's callback that reports success or failure of a function."""

        def callback(request: Any, response: Any) -> Any:
            response.ok = True
            try:
                with self.lock:
                    work(request, response)
            except Exception as error:  # classes of the user's may raise anything
                if not isinstance(error, ControlError | UserError):
                    self.get_logger().error(traceback.format_exc())
                response.ok = False
                if hasattr(response, "message"):
                    response.message = str(error)
                self.get_logger().error(str(error))
            self._publish_activity()
            return response

        return callback

    @property
    def _running(self) -> ControllerManager:
        assert self.manager is not None, "services are there once the manager is"
        return self.manager

    @property
    def _spinning(self) -> Executor:
        """Executor of this node, which also runs the nodes of its controllers."""
        executor = self.executor
        assert executor is not None, "a service can only be called while somebody spins"
        return executor

    def _load(self, request: Any, response: Any) -> None:
        name = request.name
        type_name = typed_value(self, f"{name}.type", "")
        files = typed_value(self, f"{name}.params_file", ())
        if name in self._running.controllers:
            raise ControlError(f"a controller '{name}' is loaded already")
        node = self._make_node(name, files)
        try:
            own_type_name = declare_one(node, "type", "", "Class of the controller.")
            type_name = type_name or own_type_name
            if not type_name:
                raise ControlError(
                    f"the type of controller '{name}' is not known: "
                    f"the parameter '{name}.type' of '{self.get_name()}' is not set"
                )
            context = ControllerContext(
                name,
                update_rate=declare_one(node, "update_rate", 0, "Rate; the manager's where 0.", unit="Hz", minimum=0),
                robot=self._robot,
                namespace=self.get_namespace(),
                has_subscribers=node.has_subscribers,
                warn=node.warn,
            )
            fallbacks = typed_value(self, f"{name}.fallback_controllers", ())
            self._running.load(name, type_name, node.read_parameters, context, fallbacks)
        except UserError:
            node.destroy_node()
            raise
        self._nodes[name] = node
        self._spinning.add_node(node)
        self.get_logger().info(f"loaded controller '{name}' ({type_name})")

    def _make_node(self, name: str, files: Iterable[str]) -> ControllerNode:
        for file in files:
            if not Path(file).is_file():
                raise ControlError(f"there is no parameter file '{file}' for controller '{name}'")
        arguments = [*self._controller_arguments]
        for file in files:
            arguments += ["--params-file", file]
        arguments += typed_value(self, f"{name}.node_options_args", ())
        sim_time: Parameter[bool] = Parameter("use_sim_time", value=bool(self.get_parameter("use_sim_time").value))
        try:
            return ControllerNode(
                name,
                self.get_namespace(),
                arguments,
                self.lock,
                context=self.context,
                use_global_arguments=self._use_global_arguments,
                parameter_overrides=[sim_time],
            )
        except (ValueError, RuntimeError) as error:  # the name, or something in a file, breaks the rules
            raise ControlError(f"controller '{name}' cannot be loaded: {error}") from error

    def _configure(self, request: Any, response: Any) -> None:
        name = request.name
        try:
            self._running.configure(name)
        except UserError as error:
            if name in self._nodes:
                self._nodes[name].disconnect()
            raise ControlError(f"controller '{name}' cannot be configured: {error}") from error
        loaded = self._running.controllers[name]
        self._nodes[name].connect(loaded.running, lambda: loaded.state == "active")
        self.get_logger().info(f"configured controller '{name}'")

    def _cleanup(self, request: Any, response: Any) -> None:
        self._running.cleanup(request.name)
        self._nodes[request.name].disconnect()

    def _unload(self, request: Any, response: Any) -> None:
        self._running.unload(request.name)
        self._forget(request.name)

    def _forget(self, name: str) -> None:
        node = self._nodes.pop(name)
        self._spinning.remove_node(node)
        node.destroy_node()
        self.get_logger().info(f"unloaded controller '{name}'")

    def _switch(self, request: Any, response: Any) -> None:
        strictness = Strictness(request.strictness) if request.strictness in range(1, 5) else Strictness.BEST_EFFORT
        done = self._running.switch(request.activate_controllers, request.deactivate_controllers, strictness)
        response.message = "; ".join(done.left_out)
        for what, names in (("deactivated", done.stop), ("activated", done.start)):
            if names:
                self.get_logger().info(f"{what} {', '.join(names)}")
        if done.left_out:
            self.get_logger().warning(f"left out: {response.message}")
            response.ok = bool(done.start or done.stop)

    def _reload(self, request: Any, response: Any) -> None:
        self._running.unload_all(force=request.force_kill)
        for name in list(self._nodes):
            self._forget(name)

    def _set_component(self, request: Any, response: Any) -> None:
        from lifecycle_msgs.msg import State

        target = request.target_state
        names = {
            State.PRIMARY_STATE_UNCONFIGURED: UNCONFIGURED,
            State.PRIMARY_STATE_INACTIVE: INACTIVE,
            State.PRIMARY_STATE_ACTIVE: "active",
            State.PRIMARY_STATE_FINALIZED: "finalized",
        }
        wanted = target.label or names.get(target.id, "")
        try:
            self._running.set_component_state(request.name, wanted)
        finally:
            if request.name in self._running.components:
                response.state = component_message(self._running, request.name).state

    def _publish_activity(self) -> None:
        if self._activity is not None and self.context.ok():
            self._activity.publish(activity_message(self._running, self.get_clock().now().to_msg()))
