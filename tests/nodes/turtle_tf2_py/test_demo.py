"""The demonstration of tf2 with turtles, and what the tutorial does with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from nodes.stepped_terminal import Terminals

pytestmark = [pytest.mark.slow, pytest.mark.scenario(timeout=300, record=False)]


@pytest.mark.parametrize("name", ["turtle_tf2_demo_launch.py", "turtle_tf2_demo.launch.py"])
def test_the_second_turtle_follows_the_first(
    name: str, terminal: Terminals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with terminal("launch", "turtle_tf2_py", name) as launched:
        launched.wait_for("Successfully spawned turtle2")
        with terminal("run", "tf2_ros", "tf2_echo", "turtle2", "turtle1", "10") as echo:
            echo.wait_for(r"Translation: \[0\.[0-4]")  # it starts 3.9 units away
            assert echo.interrupt() == 0
        words = ("run", "tf2_tools", "view_frames", "--wait-time", "1", "-o", "tree")
        with terminal(*words) as view:
            view.wait_for("Listening to tf data for 1.0 seconds...")
            view.wait_for(r"Result:tf2_msgs.srv.FrameGraph_Response\(frame_yaml=.turtle[12]: ")
            view.wait_for("Exporting graph in tree.pdf file...")
            assert view.wait() == 0
        assert sorted(path.name for path in tmp_path.iterdir()) == ["tree.gv", "tree.pdf", "tree.svg"]
        assert "turtle1" in (tmp_path / "tree.svg").read_text()
        assert launched.interrupt() == 0


@pytest.mark.parametrize(
    ("name", "frame"),
    [("turtle_tf2_fixed_frame_demo_launch.py", "carrot1"), ("turtle_tf2_dynamic_frame_demo_launch.py", "carrot1")],
)
def test_carrots(name: str, frame: str, terminal: Terminals) -> None:
    with terminal("launch", "turtle_tf2_py", name) as launched:
        with terminal("run", "tf2_ros", "tf2_echo", "world", frame, "10") as echo:
            echo.wait_for("Translation")
            assert echo.interrupt() == 0
        assert launched.interrupt() == 0


def test_a_turtle_that_a_sensor_sees(terminal: Terminals) -> None:
    with terminal("launch", "turtle_tf2_py", "turtle_tf2_sensor_message_launch.py") as launched:
        launched.wait_for("Successfully spawned turtle3")
        words = ("/turtle3/turtle_point_stamped", "geometry_msgs/msg/PointStamped")
        with terminal("topic", "echo", "--once", *words) as echo:
            echo.wait_for("frame_id: world")
        assert launched.interrupt() == 0


def test_a_turtle_that_stays(terminal: Terminals) -> None:
    words = ("run", "turtle_tf2_py", "static_turtle_tf2_broadcaster")
    with terminal(*words, "mystaticturtle", "0", "0", "1", "0", "0", "0") as publisher:
        with terminal("topic", "echo", "--once", "/tf_static", "tf2_msgs/msg/TFMessage") as echo:
            echo.wait_for("child_frame_id: mystaticturtle")
        assert publisher.interrupt() == 0
    with terminal(*words, "mystaticturtle") as publisher:
        assert publisher.wait(30) == 1
        assert "Invalid number of parameters. Usage:" in publisher.text
