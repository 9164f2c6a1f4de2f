"""What a user meets who mistypes: one or two lines that say what is near, never a traceback."""

import signal
import subprocess

import pytest

from .commands import ROS2, ros2, ros2_here

NODE = """
import rclpy
from geometry_msgs.msg import Twist
from std_msgs.msg import String
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from rclpy.action import ActionServer
rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(String, "chatter", 10)
node.create_subscription(Twist, "cmd_vel", print, 10)
node.create_service(AddTwoInts, "add_two_ints", lambda request, response: response)
ActionServer(node, Fibonacci, "fibonacci", lambda goal: Fibonacci.Result())
node.declare_parameter("speed", 1.0)
node.create_timer(0.1, lambda: publisher.publish(String(data="hello")))
rclpy.spin(node)
"""
FIBONACCI = "example_interfaces/action/Fibonacci"
TWIST = "geometry_msgs/msg/Twist"
_BRIEFLY = ["topic", "pub", "--once", "--max-wait-time-secs", "1.1"]


@pytest.mark.parametrize(
    ("line", "status", "lines"),
    [
        ("topc list", 2, ["Did you mean 'topic'?"]),
        (
            "topic pub --max-wait-time-secs 1 /x std_msgs/msg/Empty",
            1,
            ["--max-wait-time-secs option is only effective"],
        ),
        ("topic ech /x", 2, ["Did you mean 'echo'?"]),
        ("run demo_nodes_pi talker", 1, ["Package 'demo_nodes_pi' not found", "Did you mean 'demo_nodes_py'"]),
        ("run demo_nodes_py talkr", 1, ["No executable found", "Did you mean 'talker'?"]),
        ("launch demo_nodes_p x.launch.py", 1, ["Package 'demo_nodes_p' not found", "Did you mean 'demo_nodes_py'"]),
        ("launch nope.launch.py", 2, ["The launch file 'nope.launch.py' does not exist"]),
        ("pkg prefix std_msg", 1, ["Package not found", "Did you mean 'std_msgs'"]),
        (
            "interface show std_msgs/msg/Strin",
            1,
            ["Could not find the interface", "Did you mean 'std_msgs/msg/String'"],
        ),
        ("interface show Twist", 1, ["Expected three parts", "Did you mean 'geometry_msgs/msg/Twist'?"]),
        ("interface show std_msg/msg/String", 1, ["Unknown package 'std_msg'", "Did you mean 'std_msgs/msg/String'"]),
        ("interface package std_msg", 1, ["Unknown package 'std_msg'", "Did you mean 'std_msgs'"]),
        ("topic echo /foo std_msgs/msg/Strng", 1, ["message type is invalid", "Did you mean 'std_msgs/msg/String'"]),
        ("topic echo /foo my_msgs/msg/Num", 1, ["message type is invalid", "The package 'my_msgs' is not here."]),
    ],
)
def test_mistakes_that_need_no_graph(capsys, line, status, lines):
    _check(ros2_here(*line.split(), capsys=capsys), status, lines)


@pytest.fixture
def talker(beside, wait_for):
    beside(NODE)
    wait_for("/talker/set_parameters")


@pytest.mark.slow
def test_mistakes_about_the_graph(env, talker):
    for words, status, lines in (
        (["topic", "echo", "/chater"], 1, ["Could not determine the type", "Did you mean '/chatter'?"]),
        (["topic", "info", "/chater"], 1, ["Unknown topic '/chater'", "Did you mean '/chatter'?"]),
        (["topic", "echo", "--field", "dat", "--once", "/chatter"], 1, ["Invalid field 'dat'", "Did you mean 'data'?"]),
        (["node", "info", "/taker"], 1, ["Unable to find node '/taker'", "Did you mean '/talker'?"]),
        (["param", "get", "/talker", "sped"], 1, ["Did you mean 'speed'?", "Parameter not set"]),
        (["param", "get", "/taker", "speed"], 1, ["Node not found", "Did you mean '/talker'?"]),
        (["param", "describe", "/talker", "sped"], 0, ["Did you mean 'speed'?"]),
        (["param", "set", "/talker", "sped", "3"], 0, ["Setting parameter failed", "Did you mean 'speed'?"]),
        (
            ["param", "set", "/talker", "speed", "[1"],
            0,
            ["Setting parameter failed", "not valid YAML: line 1, column 3"],
        ),
        (["param", "load", "/talker", "missing.yaml"], 1, ["missing.yaml: No such file or directory"]),
        (["topic", "type", "/chater"], 1, ["Unknown topic '/chater'", "Did you mean '/chatter'?"]),
        (
            ["service", "call", "/add_two_ints", "std_srvs/srv/Empty"],
            1,
            ["'/add_two_ints' has the type example_interfaces/srv/AddTwoInts, not std_srvs/srv/Empty"],
        ),
        (
            ["action", "send_goal", "/fibonacci", "turtlesim/action/RotateAbsolute"],
            1,
            [f"'/fibonacci' has the type {FIBONACCI}, not turtlesim/action/RotateAbsolute"],
        ),
        (["action", "info", "/sum"], 0, ["There are these actions: /fibonacci"]),
        (["service", "info", "/add_two_int"], 1, ["Unknown service", "Did you mean '/add_two_ints'?"]),
        ([*_BRIEFLY, "/cmd_vl", TWIST], 1, ["Did you mean '/cmd_vel'?"]),
        ([*_BRIEFLY, "/cmd_vel", "std_msgs/msg/String"], 1, [f"'/cmd_vel' is listened to as {TWIST}"]),
    ):
        _check(ros2(*words, env=env), status, lines)
    for line, hint in (
        (
            "service call /sum example_interfaces/srv/AddTwoInts",
            "There are these services of type example_interfaces/srv/AddTwoInts: /add_two_ints",
        ),
        ("service call /sum nav_msgs/srv/GetMap", "There are no services of type nav_msgs/srv/GetMap"),
        (f"action send_goal /sum {FIBONACCI}", "There are these actions: /fibonacci"),
    ):
        assert _first_hint_while_waiting(line, env) == hint


def _first_hint_while_waiting(line, env):
    """Return the first line on standard error of a command that waits for what may still come."""
    with subprocess.Popen([*ROS2, *line.split()], stderr=subprocess.PIPE, text=True, env=env) as process:
        assert process.stderr is not None
        hint = process.stderr.readline().rstrip()
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
    return hint


@pytest.mark.parametrize(
    ("values", "fault"),
    [
        ("{linear: [}", "The passed value is not valid YAML: line 1, column 11: "),
        ("{lnear: {x: 1}}", "Did you mean 'linear'?"),
        ("{linear: {speed: 1}}", "'Vector3' object has no attribute 'speed'"),
        ("{linear: {x:1.5}}", "Did you mean 'x: 1.5'? YAML wants a space after the colon"),
        ("{linear: {x: fast}}", "field 'x' of geometry_msgs/msg/Vector3: could not convert string to float: 'fast'"),
        ("3", "needs to be a dictionary in YAML format"),
    ],
)
def test_values_that_do_not_fit(env, values, fault):
    _check(ros2("topic", "pub", "--once", "/cmd_vel", TWIST, values, env=env), 1, [fault])


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (["-p", "x:=[1"], "parse parameter override rule: '-p x:=[1': line 1, column "),
        (["-r", "x"], "parse remap rule: 'x'"),
        (["--nope"], "Found unknown ROS arguments: "),
        (["--params-file", "missing.yaml"], "'--params-file missing.yaml': No such file or directory"),
        (["-p", "use_sim_time:=3"], "Trying to set parameter 'use_sim_time' to '3' of type 'INTEGER'"),
    ],
)
def test_ros_arguments_that_do_not_fit(env, words, fault):
    _check(ros2("run", "demo_nodes_py", "talker", "--ros-args", *words, env=env), 1, [fault])


@pytest.mark.slow
def test_environments_that_do_not_fit(env):
    for words in (["topic", "list", "--no-daemon"], ["run", "demo_nodes_py", "talker"]):
        _check(ros2(*words, env={**env, "ROS_DOMAIN_ID": "abc"}), 1, ["ROS_DOMAIN_ID is 'abc', expected a number"])


LAUNCH_FILES = {
    "a.launch.py": ("from launch_ros.actions import Nod\n", "a.launch.py:1: ImportError"),
    "b.launch.py": ("def generate_launch_description(:\n    pass\n", "b.launch.py:1: SyntaxError"),
    "c.launch.py": ("x = 1\n", "does not contain the required function 'generate_launch_description()'"),
    "d.launch.xml": ("<launch>\n  <nod pkg='a'/>\n</launch>\n", "d.launch.xml:2: Unrecognized entity of the type: nod"),
    "e.launch.xml": ("<launch>\n  <node>\n</launch>\n", "e.launch.xml:3: malformed XML"),
    "f.launch.xml": (
        "<launch>\n\n  <node pkg='demo_nodes_py' exec='talkr'/>\n</launch>\n",
        "f.launch.xml:3: No executable 'talkr' in package 'demo_nodes_py'; did you mean 'talker'",
    ),
    "g.launch.yaml": ("launch:\n- node:\n    pkg: 'a\n", "g.launch.yaml:4: malformed YAML"),
    "h.launch.yaml": (
        "launch:\n- node:\n    pkg: demo_nodes_py\n    exec: talker\n    nam: x\n",
        "h.launch.yaml:3: Unexpected key(s) found in `node`: nam",
    ),
    "i.launch.xml": ("<launch>\n  <include file='d.launch.xml'/>\n</launch>\n", "d.launch.xml:2: Unrecognized entity"),
}


KNOWN_ONLY_WHEN_LAUNCHED = {"f.launch.xml", "i.launch.xml"}


@pytest.mark.parametrize("name", LAUNCH_FILES)
def test_launch_files_with_a_mistake(env, tmp_path, name):
    for file, (text, _) in LAUNCH_FILES.items():
        (tmp_path / file).write_text(text)
    done = ros2("launch", name, env={**env, "ROS_LOG_DIR": str(tmp_path)}, cwd=tmp_path)
    _check(done, 1 if name in KNOWN_ONLY_WHEN_LAUNCHED else 2, [LAUNCH_FILES[name][1]])


def test_a_malformed_launch_argument(env, tmp_path):
    (tmp_path / "a.launch.xml").write_text("<launch/>")
    fault = "malformed launch argument 'a=1', expected format '<name>:=<value>'"
    _check(ros2("launch", "a.launch.xml", "a:=1", "a=1", env=env, cwd=tmp_path), 1, [fault])


def _check(result, status, lines):
    told = result.out + result.err
    for line in lines:
        assert line in told
    assert "Traceback" not in told
    assert result.status == status, told


HIDDEN = "import rclpy\nrclpy.init()\nrclpy.spin(rclpy.create_node('_hidden'))\n"


@pytest.mark.slow
def test_a_hidden_node_is_shown_where_hidden_ones_are_asked_for(env, beside, wait_for):
    beside(HIDDEN)
    wait_for("/_hidden/set_parameters")
    _check(ros2("node", "info", "/_hidden", env=env), 1, ["Unable to find node '/_hidden'"])
    shown = ros2("node", "info", "--include-hidden", "/_hidden", env=env)
    assert shown.out.startswith("/_hidden\n  Subscribers:\n")
