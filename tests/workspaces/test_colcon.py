"""A workspace with packages of every kind, built and used as the course does."""

import json
import shutil

import psutil
import pytest

from terminals import Terminal, environment

from . import packages
from .conftest import DOMAIN

pytestmark = pytest.mark.slow

PUBLISHER = """
    import rclpy
    from rclpy.node import Node
    from tutorial_interfaces.msg import Sphere


    class MinimalPublisher(Node):

        def __init__(self):
            super().__init__('minimal_publisher')
            self.publisher_ = self.create_publisher(Sphere, 'topic', 10)
            self.timer = self.create_timer(0.5, self.timer_callback)
            self.i = 0

        def timer_callback(self):
            msg = Sphere()
            msg.radius = float(self.i)
            self.publisher_.publish(msg)
            self.get_logger().info('Publishing: "%s"' % msg.radius)
            self.i += 1


    def main(args=None):
        rclpy.init(args=args)
        minimal_publisher = MinimalPublisher()
        rclpy.spin(minimal_publisher)
        minimal_publisher.destroy_node()
        rclpy.shutdown()
    """
SERVICE = """
    import rclpy
    from rclpy.node import Node
    from tutorial_interfaces.srv import AddThreeInts


    class MinimalService(Node):

        def __init__(self):
            super().__init__('minimal_service')
            self.srv = self.create_service(AddThreeInts, 'add_three_ints', self.add_three_ints_callback)

        def add_three_ints_callback(self, request, response):
            response.sum = request.a + request.b + request.c
            self.get_logger().info('Incoming request\\na: %d b: %d c: %d' % (request.a, request.b, request.c))
            return response


    def main():
        rclpy.init()
        rclpy.spin(MinimalService())
    """
LAUNCH = """
    from launch import LaunchDescription
    from launch.substitutions import PathJoinSubstitution
    from launch_ros.actions import Node
    from launch_ros.substitutions import FindPackageShare


    def generate_launch_description():
        config = PathJoinSubstitution([FindPackageShare('files_only'), 'config', 'turtlesim.yaml'])
        return LaunchDescription([
            Node(package='mixed', executable='reporter.py', name='sim', output='screen', parameters=[config]),
        ])
    """
REPORTER = """
    #!/usr/bin/env python3
    import rclpy
    from mixed.words import greeting

    rclpy.init()
    node = rclpy.create_node('reporter')
    node.declare_parameter('background_r', 0)
    print(greeting(node.get_parameter('background_r').value), flush=True)
    rclpy.shutdown()
    """


AREA = """
    #include "tutorial_interfaces/msg/Sphere.idl"
    module tutorial_interfaces {
      module msg {
        struct Area {
          sequence<tutorial_interfaces::msg::Sphere> parts;
          @default (value=2.5) double size;
        };
      };
    };
    """


@pytest.fixture(scope="module")
def built(workspace, tmp_path_factory):
    """The workspace, built; what colcon printed is its second part."""
    source = workspace / "src"
    packages.cmake_package(
        source,
        "tutorial_interfaces",
        """
        find_package(geometry_msgs REQUIRED)
        find_package(rosidl_default_generators REQUIRED)
        rosidl_generate_interfaces(${PROJECT_NAME}
          "msg/Num.msg"
          "msg/Sphere.msg"
          "msg/Area.idl"
          "srv/AddThreeInts.srv"
          "action/Fibonacci.action"
          DEPENDENCIES geometry_msgs # Add packages that above messages depend on
        )
        """,
        {
            "msg/Num.msg": "int64 num\n",
            "msg/Area.idl": AREA,
            "msg/Sphere.msg": "geometry_msgs/Point center\nfloat64 radius\n",
            "srv/AddThreeInts.srv": "int64 a\nint64 b\nint64 c\n---\nint64 sum\n",
            "action/Fibonacci.action": "int32 order\n---\nint32[] sequence\n---\nint32[] partial_sequence\n",
        },
        packages.INTERFACES_XML,
    )
    packages.python_package(
        source,
        "py_pubsub",
        {"talker": PUBLISHER, "service": SERVICE},
        needs="rclpy tutorial_interfaces",
        more={
            "test/test_math.py": "def test_math():\n    assert 2 + 2 == 4\n",
            "test/test_wrong.py": "def test_wrong():\n    assert 2 + 2 == 5\n",
        },
    )
    packages.cmake_package(
        source,
        "files_only",
        "install(DIRECTORY launch config urdf DESTINATION share/${PROJECT_NAME}/)",
        {
            "launch/sim.launch.py": LAUNCH,
            "config/turtlesim.yaml": "sim:\n  ros__parameters:\n    background_r: 150\n",
            "urdf/robot.urdf": "<robot name='r'><link name='base_link'/></robot>\n",
        },
    )
    packages.cmake_package(
        source,
        "mixed",
        """
        find_package(ament_cmake_python REQUIRED)
        find_package(rclcpp REQUIRED)
        add_executable(plain src/plain.cpp)
        add_executable(talker src/talker.cpp)
        find_package(moveit_core REQUIRED)
        ament_target_dependencies(talker rclcpp moveit_core)
        install(TARGETS plain talker DESTINATION lib/${PROJECT_NAME})
        ament_python_install_package(${PROJECT_NAME})
        install(PROGRAMS scripts/reporter.py DESTINATION lib/${PROJECT_NAME})
        if(BUILD_TESTING)
          find_package(ament_cmake_pytest REQUIRED)
          ament_add_pytest_test(words test/test_words.py TIMEOUT 60 ENV PLACE=mixed)
          ament_add_pytest_test(elsewhere test/test_words.py WORKING_DIRECTORY test ENV PLACE=test)
        endif()
        """,
        {
            "src/plain.cpp": '#include <cstdio>\nint main() { std::printf("plain C++\\n"); }\n',
            "src/talker.cpp": "#include <rclcpp/rclcpp.hpp>\nint main() {}\n",
            "mixed/__init__.py": "",
            "mixed/words.py": "def greeting(number):\n    return f'red is {number}'\n",
            "scripts/reporter.py": REPORTER,
            "test/test_words.py": (
                "import os\nfrom mixed.words import greeting\n\n\ndef test_greeting():\n"
                "    assert greeting(3) == 'red is 3'\n"
                "    assert os.path.basename(os.getcwd()) == os.environ['PLACE']\n"
            ),
        },
    )
    terminal = Terminal(environment(DOMAIN, workspace.parent), workspace)
    try:
        printed = terminal.run("colcon build --symlink-install")
        assert terminal.status == 0, printed
    finally:
        terminal.close()
    return workspace, printed


@pytest.fixture
def sourced(built, terminal):
    """Opens terminals in which the workspace has been sourced."""

    def open_one():
        one = terminal()
        assert one.run("source install/setup.bash") == ""
        return one

    return open_one


def test_packages_are_listed_with_who_builds_them(built, terminal):
    assert terminal().run("colcon list").splitlines() == [
        "files_only\tsrc/files_only\t(ros.ament_cmake.daidalos)",
        "mixed\tsrc/mixed\t(ros.ament_cmake.daidalos)",
        "py_pubsub\tsrc/py_pubsub\t(ros.ament_python.daidalos)",
        "tutorial_interfaces\tsrc/tutorial_interfaces\t(ros.ament_cmake.daidalos)",
    ]


def test_a_build_says_in_one_line_what_it_leaves_out(built):
    _, printed = built
    assert "Summary: 4 packages finished" in printed
    line = next(line for line in printed.splitlines() if "left out" in line)
    assert line.startswith("mixed: left out: talker (it needs the C++ package 'moveit_core', which is not there")
    assert "1 package had stderr output: mixed" in printed


def test_dependencies_are_built_first(built):
    _, printed = built
    assert printed.index("Finished <<< tutorial_interfaces") < printed.index("Starting >>> py_pubsub")


def test_sourcing_shows_packages_and_executables(sourced, workspace):
    one = sourced()
    assert {"files_only", "mixed", "py_pubsub", "tutorial_interfaces"} <= set(one.run("ros2 pkg list").split())
    assert one.run("ros2 pkg prefix py_pubsub").strip() == str(workspace / "install" / "py_pubsub")
    assert one.run("ros2 pkg executables py_pubsub").splitlines() == ["py_pubsub service", "py_pubsub talker"]
    executables = one.run("ros2 pkg executables mixed").splitlines()
    assert "mixed reporter.py" in executables
    assert "mixed talker" not in executables
    if shutil.which("c++") or shutil.which("g++"):
        assert one.run("ros2 run mixed plain").strip() == "plain C++"


def test_unsourced_terminals_do_not_see_the_workspace(built, terminal):
    assert "py_pubsub" not in terminal().run("ros2 pkg list").split()


def test_own_interfaces_are_shown(sourced):
    one = sourced()
    assert one.run("ros2 interface show tutorial_interfaces/msg/Num").splitlines() == ["int64 num"]
    assert one.run("ros2 interface show tutorial_interfaces/msg/Sphere").splitlines() == [
        "geometry_msgs/Point center",
        "\tfloat64 x",
        "\tfloat64 y",
        "\tfloat64 z",
        "float64 radius",
    ]
    shown = one.run("ros2 interface show tutorial_interfaces/msg/Area").splitlines()
    assert (shown[0], shown[-1]) == ("tutorial_interfaces/Sphere[] parts", "float64 size 2.5")
    assert one.run("ros2 interface package tutorial_interfaces").split() == [
        "tutorial_interfaces/action/Fibonacci",
        "tutorial_interfaces/msg/Area",
        "tutorial_interfaces/msg/Num",
        "tutorial_interfaces/msg/Sphere",
        "tutorial_interfaces/srv/AddThreeInts",
    ]


def test_own_interfaces_are_installed_with_their_hashes(built, workspace):
    share = workspace / "install" / "tutorial_interfaces" / "share" / "tutorial_interfaces"
    description = json.loads((share / "msg" / "Sphere.json").read_text())
    names = [row["type_name"] for row in description["type_hashes"]]
    assert names == ["tutorial_interfaces/msg/Sphere", "geometry_msgs/msg/Point"]
    point = "RIHS01_6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881"
    assert description["type_hashes"][1]["hash_string"] == point
    assert (share / "msg" / "Sphere.msg").is_symlink()


def test_own_messages_travel(sourced):
    talker, listener = sourced(), sourced()
    talker.start("ros2 run py_pubsub talker")
    talker.wait_for(r'\[INFO\] \[[\d.]+\] \[minimal_publisher\]: Publishing: "0\.0"')
    printed = listener.run("ros2 topic echo --once /topic")
    assert printed.startswith("center:\n  x: 0.0\n  y: 0.0\n  z: 0.0\nradius: ")
    assert "tutorial_interfaces/msg/Sphere" in listener.run("ros2 topic info /topic")


def test_own_services_are_called(sourced):
    server, client = sourced(), sourced()
    server.start("ros2 run py_pubsub service")
    printed = client.run('ros2 service call /add_three_ints tutorial_interfaces/srv/AddThreeInts "{a: 2, b: 3, c: 1}"')
    assert "tutorial_interfaces.srv.AddThreeInts_Response(sum=6)" in printed
    server.wait_for("a: 2 b: 3 c: 1")


def test_launch_files_and_configurations_of_the_workspace(sourced):
    printed = sourced().run("ros2 launch files_only sim.launch.py")
    assert "red is 150" in printed


def test_an_edit_takes_effect_without_a_build(sourced, workspace):
    module = workspace / "src" / "mixed" / "mixed" / "words.py"
    before = module.read_text()
    module.write_text(before.replace("red is", "rouge is"))
    try:
        assert "rouge is 0" in sourced().run("ros2 run mixed reporter.py")
    finally:
        module.write_text(before)


def test_tests_are_run_and_their_results_shown(built, terminal):
    one = terminal()
    printed = one.run("colcon test --packages-select py_pubsub mixed")
    assert "1 package had test failures: py_pubsub" in printed
    printed = one.run("colcon test-result --all --verbose")
    assert one.status == 1
    assert "test_results/mixed/words.xunit.xml: 1 test, 0 errors, 0 failures, 0 skipped" in printed
    assert "build/py_pubsub/pytest.xml: 2 tests, 0 errors, 1 failure, 0 skipped" in printed
    assert "assert (2 + 2) == 5" in printed
    assert "Summary: 4 tests, 0 errors, 1 failure, 0 skipped" in printed


def test_rosdep_finds_everything(built, terminal):
    one = terminal()
    printed = one.run("rosdep install -i --from-path src --rosdistro jazzy -y")
    assert printed.splitlines()[-1] == "#All required rosdeps installed successfully"


def test_what_is_gone_from_the_source_goes_from_the_prefix(built, terminal, workspace):
    one = terminal()
    installed = workspace / "install" / "files_only" / "share" / "files_only" / "urdf"
    assert (installed / "robot.urdf").is_file()
    (workspace / "src" / "files_only" / "urdf" / "robot.urdf").rename(workspace / "robot.urdf")
    try:
        assert "1 package finished" in one.run("colcon build --symlink-install --packages-select files_only")
        assert not installed.exists()
    finally:
        (workspace / "robot.urdf").rename(workspace / "src" / "files_only" / "urdf" / "robot.urdf")


def test_overlays_hide_what_lies_below(built, terminal, workspace):
    overlay = workspace.parent / "overlay_ws"
    packages.python_package(overlay / "src", "py_pubsub", {"talker": "def main():\n    print('from the overlay')\n"})
    packages.python_package(
        overlay / "src",
        "uses_below",
        {"show": "from tutorial_interfaces.msg import Num\n\n\ndef main():\n    print(Num(num=7))\n"},
        needs="tutorial_interfaces",
    )
    one = terminal()
    one.run(f"source install/setup.bash && cd {overlay}")
    printed = one.run("colcon build")
    assert "2 packages finished" in printed
    fresh = terminal()
    fresh.run(f"source {overlay}/install/setup.bash")
    assert fresh.run("ros2 run py_pubsub talker").strip() == "from the overlay"
    assert fresh.run("ros2 run uses_below show").strip() == "tutorial_interfaces.msg.Num(num=7)"
    assert "files_only" in fresh.run("ros2 pkg list")
    local = terminal()
    local.run(f"source {overlay}/install/local_setup.bash")
    assert "files_only" not in local.run("ros2 pkg list")


@pytest.mark.parametrize("shell", ["zsh", "pwsh"])
def test_other_shells_can_source_it(built, terminal, workspace, shell):
    script = workspace / "install" / ("setup.zsh" if shell == "zsh" else "setup.ps1")
    assert script.is_file()
    if shutil.which(shell) is None:
        pytest.skip(f"there is no {shell}")
    if shell == "zsh":
        command = f"zsh -c 'source {script} && ros2 pkg prefix mixed'"
    else:
        command = f"pwsh -Command '. {script}; ros2 pkg prefix mixed'"
    assert terminal().run(command).strip() == str(workspace / "install" / "mixed")


def test_a_package_of_ros_1_shares_what_it_holds(workspace, terminal):
    """As it was used from its own folder there: with messages, launch files and scripts, installed or not."""
    folder = packages.write(
        workspace.parent / "catkin_ws" / "src" / "beginner_tutorials",
        {
            "package.xml": """
                <package>
                  <name>beginner_tutorials</name>
                  <version>0.1.0</version>
                  <description>ROS 1</description>
                  <maintainer email="me@example.org">me</maintainer>
                  <license>BSD</license>
                  <buildtool_depend>catkin</buildtool_depend>
                  <build_depend>message_generation</build_depend>
                  <run_depend>std_msgs</run_depend>
                </package>
                """,
            "CMakeLists.txt": """
                cmake_minimum_required(VERSION 2.8.3)
                project(beginner_tutorials)
                find_package(catkin REQUIRED COMPONENTS roscpp rospy std_msgs message_generation)
                add_executable(listener src/listener.cpp)
                target_link_libraries(listener ${catkin_LIBRARIES})
                add_message_files(FILES Num.msg)
                generate_messages(DEPENDENCIES std_msgs)
                catkin_package()
                catkin_install_python(PROGRAMS scripts/say.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
                """,
            "msg/Num.msg": "int64 num\n",
            "launch/all.launch": "<launch/>\n",
            "scripts/say.py": "#!/usr/bin/env python3\nprint('said')\n",
            "src/listener.cpp": "#include <ros/ros.h>\n",
            "src/hello.py": "#! /usr/bin/env python3\nprint('Hello world')\n",
        },
    )
    one = terminal()
    one.run(f"cd {folder.parents[1]}")
    printed = one.run("colcon build --symlink-install")
    assert "1 package finished" in printed
    one.run("source install/setup.bash")
    assert one.run("ros2 interface show beginner_tutorials/msg/Num").strip() == "int64 num"
    assert one.run("ros2 run beginner_tutorials say.py").strip() == "said"
    assert one.run("ros2 run beginner_tutorials hello.py").strip() == "Hello world"
    assert one.run("ros2 run beginner_tutorials listener").strip() == (
        "No executable found: 'listener' is C++ and was left out of the build: "
        "it needs roscpp, rospy, std_msgs, message_generation, of which only the Python side comes with Daidalos"
    )
    assert (folder.parents[1] / "install/beginner_tutorials/share/beginner_tutorials/launch/all.launch").is_file()


def test_a_test_that_does_not_end_is_ended_with_what_it_started(workspace, terminal):
    packages.cmake_package(
        workspace / "src",
        "endless",
        """
        ament_add_pytest_test(endless test/test_endless.py TIMEOUT 2)
        ament_add_pytest_test(breaks test/conftest_breaks.py)
        ament_add_gtest(compiled test/test.cpp)
        """,
        {
            "test/test_endless.py": "import subprocess\n\n\ndef test():\n    subprocess.run(['sleep', '4217'])\n",
            "test/conftest_breaks.py": "import no_such_module\n",
        },
    )
    try:
        one = terminal()
        assert "endless: left out: compiled (a test in C++)" in one.run("colcon build --packages-select endless")
        printed = one.run("colcon test --packages-select endless")
        assert "1 package had test failures: endless" in printed
        assert not [one for one in psutil.process_iter(["cmdline"]) if one.info["cmdline"] == ["sleep", "4217"]]
        printed = one.run("colcon test-result --test-result-base build/endless --verbose")
        assert "The test did not end within 2 s." in printed
        assert "breaks.xunit.xml: 1 test, 1 error" in printed
    finally:
        shutil.rmtree(workspace / "src" / "endless")


def test_hooks_of_packages_set_the_environment(workspace, terminal):
    folder = packages.cmake_package(
        workspace.parent / "hooks_ws" / "src",
        "hooked",
        """
        ament_environment_hooks("${CMAKE_CURRENT_SOURCE_DIR}/env/models.dsv.in" env/word.sh)
        install(DIRECTORY models DESTINATION share/${PROJECT_NAME})
        """,
        {
            "env/models.dsv.in": "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/@PROJECT_NAME@/models\n",
            "env/word.sh": "export A_WORD=said\n",
            "models/robot/model.sdf": "<sdf/>\n",
        },
    )
    one = terminal()
    one.run(f"cd {folder.parents[1]}")
    assert "1 package finished" in one.run("colcon build")
    one.run("source install/setup.bash")
    models = folder.parents[1] / "install" / "hooked" / "share" / "hooked" / "models"
    assert one.run('echo "$GZ_SIM_RESOURCE_PATH $A_WORD"').strip() == f"{models} said"


def test_arguments_for_cmake_count(workspace, terminal):
    body = """
        option(WITH_EXTRA "" ON)
        if(WITH_EXTRA)
          install(FILES extra.txt DESTINATION share/${PROJECT_NAME})
        endif()
        if(BUILD_TESTING)
          message(FATAL_ERROR "tests")
        endif()
        """
    packages.cmake_package(workspace / "src", "optional_parts", body, {"extra.txt": ""})
    extra = workspace / "install" / "optional_parts" / "share" / "optional_parts" / "extra.txt"
    one = terminal()
    try:
        assert "CMakeLists.txt:10: tests" in one.run("colcon build --packages-select optional_parts")
        command = "colcon build --packages-select optional_parts --cmake-args -DBUILD_TESTING=OFF"
        assert "1 package finished" in one.run(f"{command} -DCMAKE_BUILD_TYPE=Release")
        assert extra.is_file()
        assert "1 package finished" in one.run(f"{command} -DWITH_EXTRA:BOOL=OFF")
        assert not extra.exists()
    finally:
        shutil.rmtree(workspace / "src" / "optional_parts")


def test_ros_2_itself_builds_where_it_is_installed(built, terminal, workspace):
    (workspace.parent / "ros" / "share" / "ament_cmake" / "cmake").mkdir(parents=True)
    printed = terminal().run(f"AMENT_PREFIX_PATH={workspace.parent}/ros colcon list --packages-select mixed")
    assert printed.strip() == "mixed\tsrc/mixed\t(ros.ament_cmake)"


def test_everything_can_go_into_one_prefix(built, terminal, workspace):
    one = terminal()
    assert "4 packages finished" in one.run("colcon build --merge-install --build-base b --install-base merged")
    one.run("source merged/setup.bash")
    assert one.run("ros2 pkg prefix mixed").strip() == str(workspace / "merged")
    assert "red is 0" in one.run("ros2 run mixed reporter.py")
    assert one.run("ros2 interface show tutorial_interfaces/msg/Num").strip() == "int64 num"
