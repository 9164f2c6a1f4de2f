"""Life cycles, containers and timers, with nodes that run."""

import os
import sys
import types

import pytest
from launch import LaunchContext, LaunchDescription, LaunchService
from launch.actions import (
    ExecuteProcess,
    GroupAction,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
)
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessIO
from launch.substitutions import TextSubstitution
from launch_ros.actions import (
    ComposableNodeContainer,
    LifecycleNode,
    LifecycleTransition,
    LoadComposableNodes,
    Node,
    PushROSNamespace,
    ROSTimer,
    SetParameter,
    SetRemap,
    SetUseSimTime,
)
from launch_ros.actions.lifecycle_transition import ACTIVATE, CLEANUP, CONFIGURE, DEACTIVATE
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
from launch_ros.descriptions import ComposableLifecycleNode, ComposableNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState, StateTransition, matches_node_name
from launch_ros.ros_adapters import ROSAdapter, get_ros_adapter, get_ros_node

MANAGED = """
import sys
import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

class Managed(LifecycleNode):
    def on_configure(self, state):
        fails = self.declare_parameter('fail', False).value
        return TransitionCallbackReturn.FAILURE if fails else TransitionCallbackReturn.SUCCESS

rclpy.init()
try:
    rclpy.spin(Managed('managed'))
except KeyboardInterrupt:
    pass
"""

CONTAINER = """
import rclpy
from composition_interfaces.srv import LoadNode

def load(request, response):
    print('LOAD', request.package_name, request.plugin_name, request.node_namespace, request.node_name,
        list(request.remap_rules), [(p.name, p.value.integer_value) for p in request.parameters], flush=True)
    response.success = request.plugin_name != 'Broken'
    response.error_message = '' if response.success else 'it is broken'
    response.full_node_name = f'{request.node_namespace}/{request.node_name}'
    return response

rclpy.init()
node = rclpy.create_node('container')
node.create_service(LoadNode, '~/_container/load_node', load)
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""


@pytest.fixture(autouse=True)
def programs(monkeypatch, domain):
    """Replace executables by the programs above, in a ROS domain of their own."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    module = types.ModuleType("daidalos.workspaces.executables")
    texts = {"managed": MANAGED, "container": CONTAINER}
    module.find_executable = lambda package, executable: [sys.executable, "-u", "-c", texts[executable]]
    monkeypatch.setitem(sys.modules, "daidalos.workspaces.executables", module)


def run(*entities, expected=0):
    service = LaunchService()
    give_up = TimerAction(period=60.0, actions=[OpaqueFunction(function=give_up_on)])
    service.include_launch_description(LaunchDescription([give_up, *entities]))
    assert service.run() == expected
    return service


def give_up_on(context):
    raise RuntimeError("nothing happened for a minute")


def on_output(action, text, *entities):
    """Visit entities once a process has printed a line with a text in it."""
    received = bytearray()

    def is_there():
        return any(text in line for line in received.splitlines(keepends=True) if line.endswith(b"\n"))

    def on_stdout(event):
        was_there = is_there()
        received.extend(event.text)
        return list(entities) if is_there() and not was_there else None

    return RegisterEventHandler(OnProcessIO(target_action=action, on_stdout=on_stdout, on_stderr=on_stdout))


# Life cycles ------------------------------------------------------------------------------------------


def test_autostart(capsys):
    node = LifecycleNode(package="p", executable="managed", name="n", namespace="ns", autostart=True)
    states = []

    def note(context):
        event = context.locals.event
        states.append((event.start_state, event.goal_state))

    run(
        RegisterEventHandler(OnStateTransition(target_lifecycle_node=node, entities=[OpaqueFunction(function=note)])),
        RegisterEventHandler(
            OnStateTransition(
                target_lifecycle_node=node, start_state="activating", goal_state="active", entities=[Shutdown()]
            )
        ),
        node,
    )
    assert node.node_name == "/ns/n"
    assert node.is_lifecycle_node
    assert states == [
        ("unconfigured", "configuring"),
        ("configuring", "inactive"),
        ("inactive", "activating"),
        ("activating", "active"),
    ]
    assert node.return_code == 0


def test_a_failed_transition_ends_the_sequence(capsys):
    node = LifecycleNode(
        package="p", executable="managed", name="n", namespace="", autostart=True, parameters=[{"fail": True}]
    )
    failed = OnStateTransition(
        target_lifecycle_node=node, start_state="configuring", goal_state="unconfigured", entities=[Shutdown()]
    )
    run(RegisterEventHandler(failed), node)
    assert "transitions after it are left out" in capsys.readouterr().out


def test_transitions_of_several_nodes():
    nodes = [LifecycleNode(package="p", executable="managed", name=f"n{i}", namespace="") for i in range(2)]
    done = []

    def arrived(context):
        done.append(context.locals.event.action.node_name)
        return [Shutdown()] if len(done) == 2 else None

    handler = OnStateTransition(
        start_state="cleaningup", goal_state="unconfigured", entities=[OpaqueFunction(function=arrived)]
    )
    transitions = [CONFIGURE, ACTIVATE, DEACTIVATE, str(CLEANUP)]
    run(
        RegisterEventHandler(handler),
        *nodes,
        LifecycleTransition(lifecycle_node_names=["/n0", "n1"], transition_ids=transitions),
    )
    assert sorted(done) == ["/n0", "/n1"]


def test_wrong_transitions():
    with pytest.raises(ValueError, match="lifecycle_node_names"):
        LifecycleTransition(lifecycle_node_names=[], transition_ids=[1])
    with pytest.raises(ValueError, match="transition_ids"):
        LifecycleTransition(lifecycle_node_names=["a"], transition_ids=[])
    with pytest.raises(ValueError, match="unknown"):
        LifecycleTransition(lifecycle_node_names=["a"], transition_ids=[99]).visit(LaunchContext())


def test_lifecycle_nodes_need_names():
    with pytest.raises(TypeError):
        LifecycleNode(package="p", executable="managed")


def transition_event(action, start, goal, label="t"):
    state = types.SimpleNamespace
    msg = state(
        timestamp=5, transition=state(label=label), start_state=state(label=start), goal_state=state(label=goal)
    )
    return StateTransition(action=action, msg=msg)


def test_which_transitions_are_handled():
    node, other = object(), object()
    event = transition_event(node, "a", "b")
    assert (event.timestamp, event.transition, event.start_state, event.goal_state) == (5, "t", "a", "b")
    for kwargs, meant in (
        ({}, True),
        ({"target_lifecycle_node": node}, True),
        ({"target_lifecycle_node": other}, False),
        ({"start_state": "a", "goal_state": "b", "transition": "t"}, True),
        ({"start_state": "b"}, False),
        ({"goal_state": "a"}, False),
        ({"transition": "u"}, False),
        ({"matcher": lambda event: True}, True),
    ):
        handler = OnStateTransition(entities=[LogInfo(msg="x")], **kwargs)
        assert handler.matches(event) is meant
        assert "StateTransition" in handler.matcher_description
    assert not OnStateTransition(entities=[]).matches(ChangeState(lifecycle_node_matcher=None, transition_id=1))
    with pytest.raises(ValueError, match="not both"):
        OnStateTransition(entities=[], matcher=lambda event: True, goal_state="a")


def test_nodes_by_name():
    action = types.SimpleNamespace(node_name="/ns/n")
    assert matches_node_name("/ns/n")(action)
    assert matches_node_name("ns/n")(action)
    assert not matches_node_name("n")(action)


# Containers -------------------------------------------------------------------------------------------


def nodes():
    return [
        ComposableNode(
            package="pkg",
            plugin="Talker",
            name="talker",
            namespace="inner",
            parameters=[{"own": 1}],
            remappings=[("a", "b")],
        ),
        ComposableNode(package="pkg", plugin="Never", condition=IfCondition("false")),
        ComposableNode(package="pkg", plugin="Broken", name="broken"),
        ComposableNode(package="pkg", plugin="Last", name="last"),
    ]


def test_container(capsys):
    container = ComposableNodeContainer(
        package="p",
        executable="container",
        name="my_container",
        namespace="",
        composable_node_descriptions=nodes(),
        output="screen",
    )
    run(
        on_output(container, b"Last", Shutdown()),
        GroupAction([PushROSNamespace("outer"), SetParameter("all", 2), SetRemap("c", "d"), container]),
    )
    printed = capsys.readouterr().out
    assert "LOAD pkg Talker /outer/inner talker ['c:=d', 'a:=b'] [('all', 2), ('own', 1)]" in printed
    assert "LOAD pkg Last /outer last" in printed
    assert "Never" not in printed
    assert "Loaded node '/outer/inner/talker' in container '/outer/my_container'" in printed
    assert "Failed to load node 'broken' of type 'Broken' in container '/outer/my_container': it is broken" in printed


@pytest.mark.slow
def test_loading_into_a_container_by_name(capsys):
    container = Node(package="p", executable="container", output="screen")
    run(
        on_output(container, b"Last", Shutdown()),
        LoadComposableNodes(composable_node_descriptions=nodes()[-1:], target_container="container"),
        container,
    )
    assert "LOAD pkg Last  last [] []" in capsys.readouterr().out


@pytest.mark.slow
def test_waiting_for_a_container_ends_with_the_launch(capsys):
    run(
        LoadComposableNodes(composable_node_descriptions=nodes()[:1], target_container="/nobody"),
        Shutdown(),
    )
    assert "Abandoning wait for the container '/nobody', due to shutdown" in capsys.readouterr().out


def test_load_requests(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text("/ns/n: {ros__parameters: {a: 1}}\n/other: {ros__parameters: {b: 2}}\n")
    description = ComposableNode(
        package="pkg",
        plugin="Plugin",
        name="n",
        namespace="/ns",
        parameters=[str(path)],
        extra_arguments=[{"use_intra_process_comms": True}],
    )
    request = get_composable_node_load_request(description, LaunchContext())
    assert (request.package_name, request.plugin_name, request.node_name, request.node_namespace) == (
        "pkg",
        "Plugin",
        "n",
        "/ns",
    )
    assert [(p.name, p.value.integer_value) for p in request.parameters] == [("a", 1)]
    assert [(p.name, p.value.bool_value) for p in request.extra_arguments] == [("use_intra_process_comms", True)]


def test_containers_in_markup(capsys, run_text):
    run_text(
        """
        <launch>
            <arg name="never" default="false"/>
            <node_container pkg="p" exec="container" name="c" namespace="ns" if="$(var never)">
                <composable_node pkg="q" plugin="Plugin" name="n" namespace="m" if="true">
                    <param name="a" value="1"/><remap from="x" to="y"/><extra_arg name="e" value="true"/>
                </composable_node>
                <composable_lifecycle_node pkg="q" plugin="Plugin" name="l" autostart="true"/>
            </node_container>
            <load_composable_node target="/ns/c" if="$(var never)">
                <composable_node pkg="q" plugin="Plugin" name="n"/>
            </load_composable_node>
            <lifecycle_node pkg="p" exec="managed" name="n" namespace="ns" autostart="false" if="$(var never)"/>
            <ros_timer period="5" if="$(var never)"><log message="x"/></ros_timer>
            <set_use_sim_time value="true" if="$(var never)"/>
        </launch>
        """
    )
    run_text(
        """
        launch:
        - node_container:
            pkg: p
            exec: container
            name: c
            namespace: ns
            if: 'false'
            composable_node:
            - {pkg: q, plugin: Plugin, name: n, param: [{name: a, value: 1}]}
        - load_composable_node:
            target: /ns/c
            if: 'false'
            composable_node: [{pkg: q, plugin: Plugin, name: n}]
        """
    )


def test_which_nodes_autostart():
    context = LaunchContext()
    assert not ComposableNode(package="p", plugin="q").autostarts(context)
    assert not ComposableLifecycleNode(package="p", plugin="q", name="n").autostarts(context)
    assert ComposableLifecycleNode(
        package="p", plugin="q", name="n", autostart=TextSubstitution(text="true")
    ).autostarts(context)


# The launch's own node ----------------------------------------------------------------------------------


def test_adapter():
    adapter = ROSAdapter(autostart=False)
    assert adapter.ros_node is None
    with pytest.raises(RuntimeError, match="not running"):
        adapter.shutdown()
    adapter.start()
    assert adapter.ros_node.get_name() == f"launch_ros_{os.getpid()}"
    assert adapter.ros_context.ok()
    with pytest.raises(RuntimeError, match="already running"):
        adapter.start()
    adapter.shutdown()


def test_one_node_for_a_launch():
    seen = []

    def look(context):
        seen.append((get_ros_node(context), get_ros_adapter(context).ros_node))

    run(OpaqueFunction(function=look), OpaqueFunction(function=look), Shutdown())
    assert seen[0][0] is seen[0][1] is seen[1][0]


def test_a_second_shutdown_is_no_error():
    process = ExecuteProcess(cmd=[sys.executable, "-c", "input()"], on_exit=Shutdown())
    run(OpaqueFunction(function=lambda context: get_ros_node(context) and None), process, Shutdown(), Shutdown())


def test_timer_and_simulated_time():
    order = []

    def note(text):
        return OpaqueFunction(function=lambda context: order.append(text))

    never = ROSTimer(period=1000.0, actions=[note("never")])
    run(ROSTimer(period=0.05, actions=[note("timer"), Shutdown()]), never)
    assert order == ["timer"]
    assert "ROSTimer(period=1000.0" in never.describe()

    run(
        SetUseSimTime(True),
        OpaqueFunction(
            function=lambda context: order.append(get_ros_node(context).get_parameter("use_sim_time").value)
        ),
        ROSTimer(period=0.01, actions=[note("no clock, no time")]),
        TimerAction(period=0.2, actions=[Shutdown()]),
    )
    assert order == ["timer", True]
