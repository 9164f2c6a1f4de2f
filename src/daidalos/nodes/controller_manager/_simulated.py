"""Controller manager inside the simulator, stepped with it."""

from __future__ import annotations

from rclpy.context import Context
from rclpy.parameter import Parameter

from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.extensions import hardware_class, substitute_unknown
from daidalos.description.ros2_control import HardwareInfo
from daidalos.nodes.controller_manager._manager_node import ControllerManagerNode
from daidalos.nodes.controller_manager._simulated_system import SimulatedSystem
from daidalos.nodes.node_thread import NodeThread
from daidalos.samples.sensors import Sample
from daidalos.simulation.plugins.ros2_control import Ros2Control


class SimulatedManager:
    """Controllers of a model: each cycle falls on its instant of simulated time, however fast that goes.

    Parameters
    ----------
    plugin : Ros2Control
        The simulation's side.
    context : Context
        Of the nodes.

    Raises
    ------
    ControlError, ExtensionError
        When the hardware cannot be used.
    """

    def __init__(self, plugin: Ros2Control, context: Context) -> None:
        self._plugin = plugin
        arguments = [word for file in plugin.files for word in ("--params-file", str(file))]
        arguments += [word for remapping in plugin.remappings for word in ("-r", remapping)]
        self._node = ControllerManagerNode(
            plugin.manager_name,
            controller_arguments=arguments,
            context=context,
            namespace=plugin.parameters.namespace or "/",
            cli_args=["--ros-args", *arguments],
            use_global_arguments=False,
            parameter_overrides=[Parameter("use_sim_time", value=True)],
        )
        self._said: list[tuple[str, Sample]] = []
        try:
            self._node.update_rate = plugin.rate
            hardware_context = HardwareContext(plugin.rate, self._node.warn)
            model = plugin.context.model
            self._node.start(model, [self._hardware(info, hardware_context) for info in plugin.hardware])
        except Exception:
            self._node.destroy_node()
            raise
        self._thread = NodeThread(self._node)
        plugin.cycle = self._cycle

    def _hardware(self, info: HardwareInfo, context: HardwareContext) -> Hardware:
        info = substitute_unknown(info, self._node.warn, SimulatedSystem.names[1])
        cls = hardware_class(info)
        return cls(info, context, self._plugin) if issubclass(cls, SimulatedSystem) else cls(info, context)

    def _cycle(self, now_ns: int) -> None:
        self._said += self._node.cycle(now_ns)

    def publish(self) -> None:
        """Publish the controllers' samples; called after the clock was published."""
        said, self._said = self._said, []
        self._node.publish(said)

    def close(self) -> None:
        """Stop the controllers and leave the graph."""
        self._plugin.cycle = None
        self._thread.stop()
        self._node.destroy_node()
