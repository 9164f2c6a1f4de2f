"""The functions behind `ros2 action`, `bag`, `component`, `doctor`, `interface`, `launch`, `lifecycle`, `multicast`."""

import argparse
import threading
from pathlib import Path

import pytest
from lifecycle_msgs.msg import Transition
from rclpy.action import ActionClient, ActionServer
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.qos import ReliabilityPolicy
from ros2action import api as actions
from ros2bag import api as bags
from ros2component import api as components
from ros2doctor import api as doctors
from ros2interface import api as interfaces
from ros2launch import api as launches
from ros2lifecycle import api as lifecycles
from ros2multicast import api as multicast
from ros2node.api import get_node_names
from test_msgs.action import Fibonacci

from ros.graph import spinning


def test_clients_and_servers_of_an_action(graph, node):
    server = ActionServer(node, Fibonacci, "/count", lambda goal: Fibonacci.Result())
    client = ActionClient(node, Fibonacci, "/count")
    found = actions.get_action_clients_and_servers(node=node, action_name="count")
    name = node.get_fully_qualified_name()
    assert found == ([(name, ["test_msgs/action/Fibonacci"])], [(name, ["test_msgs/action/Fibonacci"])])
    assert "/count" in actions.get_action_names(node=node)
    client.destroy()
    server.destroy()


def test_states_of_managed_nodes(graph, node):
    class Managed(LifecycleNode):
        def on_configure(self, state):
            return TransitionCallbackReturn.SUCCESS

    managed = Managed("managed")
    with spinning(managed):
        assert [one.full_name for one in lifecycles.get_node_names(node=node)] == ["/managed"]
        states = lifecycles.call_get_states(node=node, node_names=["/managed"])
        assert states["/managed"].label == "unconfigured"
        offered = lifecycles.call_get_available_transitions(node=node, states=states)["/managed"]
        assert {one.transition.label for one in offered} == {"configure", "shutdown"}
        configure = Transition(id=Transition.TRANSITION_CONFIGURE)
        assert lifecycles.call_change_states(node=node, transitions={"/managed": configure}) == {"/managed": True}


def test_there_are_no_containers(graph, node):
    assert components.find_container_node_names(node=node, node_names=get_node_names(node=node)) == []
    assert components.get_package_component_types(package_name="ros2component") == []


def test_profiles_of_a_file():
    profile = bags.interpret_dict_as_qos_profile({"reliability": "best_effort", "deadline": {"sec": 1, "nsec": 5}})
    assert (profile.reliability, profile.deadline.nanoseconds) == (ReliabilityPolicy.BEST_EFFORT, 1_000_000_005)
    for faulty in ({"depht": 1}, {"depth": -1}, {"deadline": {"sec": 1}}, {"lifespan": {"sec": -1, "nsec": 0}}):
        with pytest.raises(ValueError, match=r"depht|negative|both seconds"):
            bags.interpret_dict_as_qos_profile(faulty)


def test_numbers_of_bag_arguments():
    assert bags.check_positive_float("0.5") == 0.5
    with pytest.raises(argparse.ArgumentTypeError, match=r"> 0\.0"):
        bags.check_positive_float("0")
    with pytest.raises(argparse.ArgumentTypeError, match="less than zero"):
        bags.check_not_negative_int("-1")


def test_a_check_that_fails_is_counted(monkeypatch):
    class Broken(doctors.DoctorCheck):
        def category(self):
            return "valves"

        def check(self):
            result = doctors.Result()
            result.add_warning()
            return result

    class Point:
        name = "Broken"

        def load(self):
            return Broken

    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: [Point()])
    assert doctors.run_checks() == (set(), 0, 1)
    assert doctors.run_checks(include_warnings=True) == ({"valves"}, 1, 1)
    with pytest.warns(UserWarning, match="failed to run"):
        assert doctors.generate_reports() == []


def test_interfaces_as_yaml():
    assert interfaces.interface_to_yaml("std_srvs/srv/SetBool") == "data: false\n"
    assert "test_msgs/action/Fibonacci" in interfaces.type_completer()


def test_launch_files_of_a_package(tmp_path, capsys):
    path = launches.get_share_file_path_from_package(package_name="turtlesim", file_name="multisim.launch.py")
    assert path in launches.get_launch_file_paths(path=str(Path(path).parents[1]))
    with pytest.raises(FileNotFoundError, match=r"nothing\.launch\.py"):
        launches.get_share_file_path_from_package(package_name="turtlesim", file_name="nothing.launch.py")
    launches.print_arguments_of_launch_file(launch_file_path=path)
    assert capsys.readouterr().out.startswith("Arguments (pass arguments as")
    assert launches.parse_launch_arguments(["a:=1", "a:=2"]) == [("a", "2")]
    with pytest.raises(RuntimeError, match="malformed launch argument 'a'"):
        launches.parse_launch_arguments(["a"])


def test_a_datagram_arrives_in_its_group():
    with multicast.open_receiver("225.0.0.7", 49151) as receiver:
        receiver.settimeout(5.0)
        sender = threading.Thread(target=multicast.send, args=(b"hello",), kwargs={"group": "225.0.0.7", "port": 49151})
        sender.start()
        try:
            data, _ = multicast.receive_from(receiver)
        except (OSError, TimeoutError):
            pytest.skip("the network has no multicast")
        finally:
            sender.join()
    assert data == b"hello"
