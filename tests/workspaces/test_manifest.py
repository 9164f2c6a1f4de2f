"""Manifests of all formats, and what is wrong with others."""

import pytest

from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.manifest import read

pytestmark = pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of a library in another
HEAD = (
    "<name>pkg</name><version>1.2.3</version><description>d</description>"
    '<maintainer email="a@b.org">A</maintainer><license>MIT</license>'
)


@pytest.fixture
def manifest(tmp_path):
    def read_text(text):
        path = tmp_path / "package.xml"
        path.write_text(text)
        return read(path)

    return read_text


def names(depends):
    return [one.name for one in depends if one.evaluated_condition]


def test_format_1(manifest):
    package = manifest(
        f"<package>{HEAD}<buildtool_depend>catkin</buildtool_depend><build_depend>a</build_depend>"
        "<run_depend>b</run_depend></package>"
    )
    assert (package.get_build_type(), names(package.build_depends), names(package.exec_depends)) == (
        "catkin",
        ["a"],
        ["b"],
    )


def test_format_2(manifest):
    package = manifest(
        f'<package format="2">{HEAD}<depend>a</depend><exec_depend>b</exec_depend><test_depend>c</test_depend>'
        "<export><build_type>ament_python</build_type></export></package>"
    )
    assert package.get_build_type() == "ament_python"
    assert (names(package.exec_depends), names(package.test_depends)) == (["b", "a"], ["c"])


def test_format_3_asks_which_ros_this_is(manifest, monkeypatch):
    for name in ("ROS_VERSION", "ROS_DISTRO", "ROS_PYTHON_VERSION"):
        monkeypatch.delenv(name, raising=False)
    package = manifest(
        f'<package format="3">{HEAD}<depend condition="$ROS_VERSION == 1">rospy</depend>'
        '<depend condition="$ROS_VERSION == 2">rclpy</depend>'
        '<export><build_type condition="$ROS_VERSION == 1">catkin</build_type>'
        '<build_type condition="$ROS_VERSION == 2">ament_python</build_type></export></package>'
    )
    assert names(package.exec_depends) == ["rclpy"]
    assert package.get_build_type() == "ament_python"


def test_what_is_no_manifest_is_none(manifest):
    assert manifest("<package-list/>") is None


@pytest.mark.parametrize(
    ("text", "line", "fault"),
    [
        ("", 1, "the file is empty"),
        ("<package>\n<name>\n</package>", 3, "not valid XML: mismatched tag"),
        ("not XML", 1, "not valid XML: syntax error"),
        (f'<package format="3">\n{HEAD.replace("1.2.3", "one")}\n</package>', 2, "version"),
        (f'<package format="3">{HEAD}\n<dependz>a</dependz></package>', 2, "dependz"),
        (f'<package format="3">\n\n{HEAD.replace("a@b.org", "nobody")}</package>', 3, "email"),
    ],
)
def test_faults_are_named_with_their_line(manifest, text, line, fault):
    with pytest.raises(WorkspaceError) as caught:
        manifest(text)
    message = str(caught.value)
    assert f"package.xml:{line}: " in message
    assert fault in message
    assert "\n" not in message
