"""The demonstration of tf2 with turtles, and what the tutorial does with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from nodes.terminal import Terminal

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", ["turtle_tf2_demo_launch.py", "turtle_tf2_demo.launch.py"])
def test_the_second_turtle_follows_the_first(name: str, domain: int, tmp_path: Path) -> None:
    with Terminal("launch", "turtle_tf2_py", name, domain=domain) as launched:
        launched.wait_for("Successfully spawned turtle2")
        with Terminal("run", "tf2_ros", "tf2_echo", "turtle2", "turtle1", "10", domain=domain) as echo:
            echo.wait_for(r"Translation: \[0\.[0-4]")  # it starts 3.9 units away
            assert echo.interrupt() == 0
        words = ("run", "tf2_tools", "view_frames", "--wait-time", "1", "-o", "tree")
        with Terminal(*words, domain=domain, folder=tmp_path) as view:
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
def test_carrots(name: str, frame: str, domain: int) -> None:
    with Terminal("launch", "turtle_tf2_py", name, domain=domain) as launched:
        with Terminal("run", "tf2_ros", "tf2_echo", "world", frame, "10", domain=domain) as echo:
            echo.wait_for("Translation")
            assert echo.interrupt() == 0
        assert launched.interrupt() == 0


def test_a_turtle_that_a_sensor_sees(domain: int) -> None:
    with Terminal("launch", "turtle_tf2_py", "turtle_tf2_sensor_message_launch.py", domain=domain) as launched:
        launched.wait_for("Successfully spawned turtle3")
        words = ("/turtle3/turtle_point_stamped", "geometry_msgs/msg/PointStamped")
        with Terminal("topic", "echo", "--once", *words, domain=domain) as echo:
            echo.wait_for("frame_id: world")
        assert launched.interrupt() == 0


def test_a_turtle_that_stays(domain: int) -> None:
    words = ("run", "turtle_tf2_py", "static_turtle_tf2_broadcaster")
    with Terminal(*words, "mystaticturtle", "0", "0", "1", "0", "0", "0", domain=domain) as publisher:
        with Terminal("topic", "echo", "--once", "/tf_static", "tf2_msgs/msg/TFMessage", domain=domain) as echo:
            echo.wait_for("child_frame_id: mystaticturtle")
        assert publisher.interrupt() == 0
    with Terminal(*words, "mystaticturtle", domain=domain) as publisher:
        assert publisher.wait(30) == 1
        assert "Invalid number of parameters. Usage:" in publisher.text
