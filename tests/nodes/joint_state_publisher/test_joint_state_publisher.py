import threading

import pytest
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import Empty

from daidalos.nodes.joint_state_publisher.joint_state_publisher import JointStatePublisher, description_from_arguments
from daidalos.nodes.joint_state_publisher_gui.joint_state_publisher_gui import JointStatePublisherGui
from daidalos.nodes.runner import UserError
from description.test_joint_values import TEXT
from ros.graph import graph, node, spinning  # noqa: F401


def parameters(**values):
    return {"parameter_overrides": [Parameter(name.replace("__", "."), value=v) for name, v in values.items()]}


class Listener:
    """Waits for states that are as wanted."""

    def __init__(self, node):  # noqa: F811
        self.last = None
        self._changed = threading.Condition()
        node.create_subscription(JointState, "/joint_states", self._take, 10)

    def _take(self, message):
        with self._changed:
            self.last = message
            self._changed.notify_all()

    def wait(self, wanted, timeout=10.0):
        with self._changed:
            assert self._changed.wait_for(lambda: self.last is not None and wanted(self.last), timeout), self.last
            return self.last


def test_it_waits_for_a_description_and_takes_other_sources(node):  # noqa: F811
    publisher = JointStatePublisher(**parameters(rate=100.0, source_list=["arm_states"], zeros__turn=0.5))
    listener = Listener(node)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with spinning(node, publisher):
        node.create_publisher(String, "/robot_description", latched).publish(String(data=TEXT))
        first = listener.wait(lambda message: True)
        assert list(first.name) == ["turn", "slide", "echo"]
        assert list(first.position) == pytest.approx([0.5, 0.4, 0.9])
        source = node.create_publisher(JointState, "/arm_states", 10)
        source.publish(JointState(name=["slide"], position=[0.6], velocity=[0.1]))
        moved = listener.wait(lambda message: message.position[1] == 0.6)
        assert moved.position[2] == pytest.approx(1.3)
        assert list(moved.velocity) == [0.0, 0.1, 0.2]
    publisher.destroy_node()


def test_a_model_in_sdf_has_joints_too(graph):  # noqa: F811
    text = """<sdf version="1.8"><model name="m"><link name="a"/><link name="b"/><joint name="j" type="revolute">
    <parent>a</parent><child>b</child><axis><limit><lower>0.5</lower><upper>1.5</upper></limit></axis></joint>
    </model></sdf>"""
    publisher = JointStatePublisher(text)
    assert publisher.values.all_positions() == [1.0]
    publisher.destroy_node()


def test_dependent_joints_are_parameters(graph):  # noqa: F811
    publisher = JointStatePublisher(
        TEXT, **parameters(dependent_joints__turn__parent="slide", dependent_joints__turn__factor=2.0)
    )
    assert publisher.values.position("turn") == pytest.approx(0.8)
    publisher.destroy_node()


def test_with_delta_joints_wander_between_their_limits(graph):  # noqa: F811
    publisher = JointStatePublisher(TEXT, **parameters(delta=0.15))
    seen = []
    for _ in range(6):
        publisher._publish()
        seen.append(round(publisher.values.positions["slide"], 2))
    assert seen == [0.55, 0.6, 0.45, 0.3, 0.2, 0.35]
    publisher.destroy_node()


def test_faulty_input_is_named(graph):  # noqa: F811
    with pytest.raises(UserError, match="<robot"):
        JointStatePublisher("<robot/>")
    with pytest.raises(UserError, match=r"'rate' of .* must be above 0, got 0"):
        JointStatePublisher(TEXT, **parameters(rate=0.0))


def test_faults_are_named_with_the_file_on_the_command_line(graph, tmp_path, monkeypatch):  # noqa: F811
    """In a xacro file, with its own lines and not those of what it becomes."""
    broken = TEXT.replace('type="continuous"', 'type="round"').replace("<robot", "\n\n<robot")
    (tmp_path / "r.urdf").write_text(broken)
    xacro = broken.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"')
    (tmp_path / "r.xacro").write_text(xacro.replace("<joint", '<xacro:property name="x" value="1"/>\n<joint', 1))
    for name, line in (("r.urdf", 4), ("r.xacro", 5)):
        monkeypatch.setattr("sys.argv", ["joint_state_publisher", str(tmp_path / name)])
        with pytest.raises(UserError, match=f'{name}:{line}: <joint name="turn">: unknown joint type'):
            JointStatePublisher(**description_from_arguments())


def test_sliders_are_parameters_within_the_limits(node):  # noqa: F811
    publisher = JointStatePublisherGui(TEXT, **parameters(rate=100.0))
    listener = Listener(node)
    with spinning(node, publisher):
        limits = publisher.describe_parameter("joints.slide").floating_point_range[0]
        assert (limits.from_value, limits.to_value) == (0.2, 0.6)
        assert publisher.set_parameters([Parameter("joints.slide", value=0.5)])[0].successful
        assert not publisher.set_parameters([Parameter("joints.slide", value=0.7)])[0].successful
        listener.wait(lambda message: message.position[1] == 0.5)
        for name, wanted in (("randomize", lambda m: m.position[0] != 0.0), ("center", lambda m: m.position[1] == 0.4)):
            client = node.create_client(Empty, f"/joint_state_publisher_gui/{name}")
            assert client.wait_for_service(5.0)
            assert client.call(Empty.Request(), 5.0) is not None
            listener.wait(wanted)
    publisher.destroy_node()
