"""A controller manager asked by functions, as programs and tests of robots do."""

import threading
from pathlib import Path

import controller_manager
import pytest
import rclpy
from controller_manager.controller_manager_services import ServiceNotFoundError
from controller_manager.test_utils import check_controllers_running, check_if_js_published, check_node_running
from lifecycle_msgs.msg import State
from rclpy.context import Context

from nodes.controller_manager.rig import FORWARD, parameter_file, rig
from ros.graph import graph  # noqa: F401

MANAGER = "/controller_manager"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


def states(node: rclpy.node.Node) -> dict[str, str]:
    return {one.name: one.state for one in controller_manager.list_controllers(node, MANAGER).controller}


def test_a_controller_lives_by_functions(graph: Context, tmp_path: Path) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "it", joints=["elbow"], interface_name="position")
    with rig(**{"it.type": FORWARD, "it.params_file": file, "told.type": BROADCASTER}):
        node = rclpy.create_node("program")
        assert FORWARD in controller_manager.list_controller_types(node, MANAGER).types
        for name in ("it", "told"):
            assert controller_manager.load_controller(node, MANAGER, name).ok
            assert controller_manager.configure_controller(node, MANAGER, name).ok
        assert not controller_manager.switch_controllers(node, MANAGER, [], ["it", "who"], True, True, 5.0).ok
        assert controller_manager.switch_controllers(node, MANAGER, [], ["it", "who"], False, True, 5.0).ok
        check_controllers_running(node, ["it"])
        with pytest.raises(AssertionError, match="not all are active: told is inactive, who is not loaded"):
            check_controllers_running(node, ["it", "told", "who"], timeout=0.1)
        check_node_running(node, "controller_manager")
        with pytest.raises(AssertionError, match="node 'who' was not there"):
            check_node_running(node, "who", timeout=0.1)
        (hardware,) = controller_manager.list_hardware_components(node, MANAGER).component
        assert hardware.name == "mock"
        interfaces = controller_manager.list_hardware_interfaces(node, MANAGER).command_interfaces
        assert [one.name for one in interfaces if one.is_claimed] == ["elbow/position"]
        inactive = State(id=State.PRIMARY_STATE_INACTIVE)
        assert controller_manager.set_hardware_component_state(node, MANAGER, "mock", inactive).ok
        assert states(node) == {"it": "inactive", "told": "inactive"}
        assert controller_manager.cleanup_controller(node, MANAGER, "it").ok
        assert controller_manager.unload_controller(node, MANAGER, "it").ok
        assert controller_manager.reload_controller_libraries(node, MANAGER, force_kill=True).ok
        assert states(node) == {}
        with pytest.raises(ServiceNotFoundError, match=r"no service /other/list_controllers within 0\.1 s"):
            controller_manager.list_controllers(node, "/other", 0.1)


def test_joints_are_told(graph: Context) -> None:  # noqa: F811
    names = [f"w{number}" for number in range(1, 5)]
    names += ["shoulder", "elbow", "finger", "s1", "s2"]
    with rig(**{"told.type": BROADCASTER}) as one:
        one.start("told")
        done = threading.Event()
        loop = threading.Thread(target=lambda: one.cycle_until(done.is_set))
        loop.start()
        try:
            check_if_js_published("/joint_states", names)
            with pytest.raises(AssertionError, match="/joint_states has the joints"):
                check_if_js_published("/joint_states", ["nose"])
        finally:
            done.set()
            loop.join()
