"""What dependencies mean."""

from pathlib import Path

import pytest

from daidalos.cli import rosdep
from daidalos.workspaces.rosdep.keys import Answer, resolve

from . import packages


@pytest.mark.parametrize(
    ("key", "answer", "distribution"),
    [
        ("rclpy", Answer.HERE, ""),
        ("std_msgs", Answer.HERE, ""),
        ("launch_ros", Answer.HERE, ""),
        ("turtlesim", Answer.HERE, ""),
        ("ament_cmake", Answer.HERE, ""),
        ("rosidl_default_generators", Answer.HERE, ""),
        ("ros2launch", Answer.HERE, ""),
        ("python3-pytest", Answer.HERE, "pytest"),
        ("python3-numpy", Answer.HERE, "numpy"),
        ("python3-yaml", Answer.HERE, "pyyaml"),
        ("python3-no-such-thing", Answer.PYTHON, "no-such-thing"),
        ("python3-no-such-thing-pip", Answer.PYTHON, "no-such-thing"),
        ("rclcpp", Answer.HERE, ""),
        ("rclcpp_action", Answer.COMPILED, ""),
        ("libopencv-dev", Answer.COMPILED, ""),
        ("urdf", Answer.COMPILED, ""),
        ("gazebo_plugins", Answer.HERE, ""),
        ("rospy", Answer.HERE, ""),
        ("roscpp", Answer.COMPILED, ""),
        ("message_generation", Answer.HERE, ""),
        ("map_server", Answer.HERE, ""),
        ("tf", Answer.HERE, ""),
        ("launch_testing_ros", Answer.HERE, ""),
        ("nav2_common", Answer.HERE, ""),
        ("vision_opencv", Answer.HERE, ""),
        ("ackermann_msgs", Answer.HERE, ""),
        ("teleop_twist_joy", Answer.HERE, ""),
        ("rviz_default_plugins", Answer.COMPILED, ""),
        ("compressed_image_transport", Answer.COMPILED, ""),
        ("tf2_ros_py", Answer.HERE, ""),
        ("navigation2", Answer.HERE, ""),
        ("desktop_full", Answer.HERE, ""),
        ("rviz_common", Answer.COMPILED, ""),
        ("spdlog_vendor", Answer.COMPILED, ""),
        ("pendulum_control", Answer.ABSENT, ""),
        ("no_such_package", Answer.UNKNOWN, ""),
    ],
)
def test_keys(key, answer, distribution):
    resolution = resolve(key)
    assert (resolution.answer, resolution.distribution) == (answer, distribution)


@pytest.fixture
def source(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    packages.python_package(tmp_path / "src", "one", {}, needs="rclpy two")
    packages.python_package(tmp_path / "src", "two", {}, needs="pluginlib python3-no-such-thing")
    packages.python_package(tmp_path / "src" / "hidden", "three", {}, needs="nothing_known")
    (tmp_path / "src" / "hidden" / "COLCON_IGNORE").write_text("")
    return tmp_path / "src"


def test_keys_of_packages(source, capsys):
    assert rosdep.main(["keys", "--from-paths", "src", "--ignore-src"]) == 0
    assert capsys.readouterr().out.split() == ["pluginlib", "python3-no-such-thing", "python3-pytest", "rclpy"]


def test_one_package_is_enough(source, capsys):
    assert rosdep.main(["keys", "one", "--from-paths", "src"]) == 0
    assert capsys.readouterr().out.split() == ["python3-pytest", "rclpy", "two"]


def test_what_is_missing_is_told_and_would_be_installed(source, capsys):
    assert rosdep.main(["check", "--from-paths", "src", "-i"]) == 1
    assert "pip\tno-such-thing" in capsys.readouterr().out
    assert rosdep.main(["install", "--from-paths", "src", "-i", "--simulate"]) == 0
    out = capsys.readouterr().out.splitlines()
    assert out[0] == "#[pip] Installation commands:"
    assert out[1].endswith(" no-such-thing")


def test_all_that_is_there_is_well(source, capsys):
    assert (
        rosdep.main(["install", "-i", "--from-path", "src", "-y", "--skip-keys", "python3-no-such-thing pluginlib"])
        == 0
    )
    assert capsys.readouterr().out == "#All required rosdeps installed successfully\n"


def test_what_only_cpp_needs_is_said(source, capsys):
    assert rosdep.main(["install", "-i", "--from-path", "src", "-y", "--skip-keys", "python3-no-such-thing"]) == 0
    assert (
        capsys.readouterr().out.splitlines()[0]
        == "#Only C++ needs pluginlib: targets that do are left out of a build here"
    )


def test_packages_of_ros_2_that_are_not_here_are_named_and_stop_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    packages.python_package(tmp_path / "src", "one", {}, needs="rclpy pendulum_control")
    for command in ("check", "install"):
        assert rosdep.main([command, "--from-paths", "src", "-i"]) == 0
        assert "#These packages of ROS 2 do not come with Daidalos: pendulum_control\n" in capsys.readouterr().out
    assert rosdep.main(["resolve", "pendulum_control"]) == 0
    assert "does not come with Daidalos" in capsys.readouterr().out


def test_unknown_dependencies_are_told_by_package(source, capsys):
    (source / "hidden" / "COLCON_IGNORE").unlink()
    assert rosdep.main(["install", "--from-paths", "src", "-i"]) == 1
    assert capsys.readouterr().err.splitlines()[-1] == "three: Cannot locate rosdep definition for [nothing_known]"


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        (["check", "--from-paths", "nowhere"], "ERROR: the path 'nowhere' does not exist"),
        (["check", "four", "--from-paths", "src"], "ERROR: no package 'four' below src"),
        (["check"], "ERROR: name a package, or folders with --from-paths"),
        (["resolve", "no_such_package"], "ERROR: no rosdep rule for 'no_such_package'"),
    ],
)
def test_mistakes_are_one_line(source, capsys, words, fault):
    assert rosdep.main(words) == 1
    assert capsys.readouterr().err.strip() == fault


@pytest.mark.parametrize("words", [["init"], ["update"], ["update", "--rosdistro", "jazzy"]])
def test_there_is_nothing_to_prepare(words, capsys):
    assert rosdep.main(words) == 0
    assert capsys.readouterr().out.startswith("Nothing to do")


def test_a_faulty_manifest_is_named(source, capsys):
    Path("src/one/package.xml").write_text("<package>")
    assert rosdep.main(["keys", "--from-paths", "src"]) == 1
    assert capsys.readouterr().err.startswith("ERROR: src/one/package.xml:1: not valid XML")
