import resource
import signal

import pytest

from daidalos.bags.metadata import read_metadata
from daidalos.bags.reader import BagReader

from ..commands import ros2
from .conftest import write_bag

pytestmark = pytest.mark.slow


def numbers(folder):
    from rclpy.serialization import deserialize_message
    from std_msgs.msg import String

    with BagReader(folder) as bag:
        return [int(deserialize_message(one.data, String).data) for one in bag.messages(["/chatter"])]


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_what_is_recorded_is_played(ros2_bag, partner, env, tmp_path, storage):
    record = ros2_bag("record", "-o", "walk", "-s", storage, "--topics", "/chatter", terminal=True)
    record.wait_for("Recording...")
    partner.talk(range(500))
    record.wait_for("Recorded 500 messages")
    record.wait_for("All requested topics are subscribed. Stopping discovery...")
    assert record.end() == 0
    assert "[rosbag2_recorder]: Starting recording to 'walk'" in record.text
    assert "[rosbag2_recorder]: Subscribed to topic '/chatter'" in record.text
    assert "[rosbag2_recorder]: Recording stopped" in record.text
    assert numbers(tmp_path / "walk") == list(range(500))
    shown = ros2("bag", "info", "walk", env=env, cwd=tmp_path)
    assert shown.status == 0
    assert f"Storage id:        {storage}\nROS Distro:        jazzy\n" in shown.out
    assert (
        "Messages:          500\nTopic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 500"
        in shown.out
    )
    assert ros2("bag", "info", "-t", "walk", env=env, cwd=tmp_path).out == "/chatter\n"
    partner.listen("/again")
    play = ros2_bag("play", "walk", "-m", "/chatter:=/again")
    assert play.finish() == 0
    assert partner.wait_for(500) == list(range(500))
    for line in ("Set rate to 1", "Press CURSOR_RIGHT for Play Next Message", "Playback until timestamp: -1"):
        assert f"[rosbag2_player]: {line}" in play.text


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_recorder_that_is_killed_leaves_a_bag(ros2_bag, partner, env, tmp_path, storage):
    record = ros2_bag("record", "-o", "walk", "-s", storage, "--topics", "/chatter")
    record.wait_for("Recording...")
    partner.talk(range(1000))
    assert _polled(lambda: _count(tmp_path / "walk") == 1000)
    assert record.end(signal.SIGKILL) == -signal.SIGKILL
    shown = ros2("bag", "info", "walk", env=env, cwd=tmp_path)
    assert "Count: 1000" in shown.out
    assert "[WARN] [ros2bag]: walk: there is no metadata.yaml; its files were read instead" in shown.err
    reindexed = ros2("bag", "reindex", "walk", env=env, cwd=tmp_path)
    assert reindexed.status == 0
    assert "Reindexing complete." in reindexed.err
    assert ros2("bag", "info", "walk", env=env, cwd=tmp_path).err == ""
    assert numbers(tmp_path / "walk") == list(range(1000))
    assert read_metadata(tmp_path / "walk").message_count == 1000


def _count(folder):
    """Return how many messages of a bag are on the disk so far."""
    with BagReader(folder) as bag:
        return bag.metadata.message_count


def _polled(condition):
    """Wait for what nobody tells of: a file that another process writes."""
    import threading

    pause = threading.Event()
    return any(condition() or pause.wait(0.05) for _ in range(400))


def test_the_keys_of_the_player(ros2_bag, partner, tmp_path):
    write_bag(tmp_path / "bag", 300)
    partner.listen()
    play = ros2_bag("play", "bag", "--start-paused", terminal=True)
    play.wait_for("[P]")
    assert "====== Playback Progress ======" in play.text
    for _ in range(3):
        play.press("\x1b[C")
    assert partner.wait_for(3) == [0, 1, 2]
    play.press("\x1b[A")
    play.wait_for("Set rate to 1.1")
    play.press("\x1b[B")
    play.press(" ")
    play.wait_for("Resuming play.")
    partner.wait_for(10)
    play.press(" ")
    play.wait_for("Pausing play.")
    play.press(" ")
    assert play.finish() == 0
    assert partner.wait_for(300) == list(range(300))
    assert "Duration 2.99/2.99 [S]" in play.text
    assert "[R]" in play.text


def test_leaps_by_key(ros2_bag, partner, tmp_path):
    write_bag(tmp_path / "bag", 300, period_ns=100_000_000)
    partner.listen()
    play = ros2_bag("play", "bag", "--start-paused", terminal=True)
    play.wait_for("[P]")
    play.press("\x1b[5~\x1b[5~\x1b[C")
    assert partner.wait_for(1) == [200]
    play.press("\x1b[6~\x1b[C")
    assert partner.wait_for(2) == [200, 100]
    play.press("\x1b[5~\x1b[5~\x1b[C")
    assert play.finish() == 0
    assert partner.numbers == [200, 100]


def test_the_keys_of_the_recorder(ros2_bag, partner, tmp_path):
    record = ros2_bag("record", "-o", "bag", "--topics", "/chatter", "--start-paused", terminal=True)
    record.wait_for("[P]")
    partner.talk(range(10))
    record.wait_for("Recorded 0 messages in 1.")
    record.press(" ")
    record.wait_for("Resuming recording.")
    partner.talk(range(10, 20))
    record.wait_for("Recorded 10 messages")
    record.press("\x03")
    assert record.end() == 0
    assert numbers(tmp_path / "bag") == list(range(10, 20))


def test_being_asked_to_end_completes_the_bag(ros2_bag, partner, tmp_path):
    words = ("--topics", "/chatter", "--compression-mode", "message", "--compression-format", "zstd")
    record = ros2_bag("record", "-o", "bag", *words, terminal=True)
    record.wait_for("Recording...")
    partner.talk(range(50))
    record.wait_for("Recorded 50 messages")
    assert record.end(signal.SIGTERM) == 0
    assert numbers(tmp_path / "bag") == list(range(50))
    assert read_metadata(tmp_path / "bag").compression_mode == "MESSAGE"


def test_scripts_end_what_they_put_in_the_background(ros2_bag, partner, tmp_path):
    def ignore():
        signal.signal(signal.SIGINT, signal.SIG_IGN)

    record = ros2_bag("record", "-o", "bag", "--topics", "/chatter", terminal=True, prepare=ignore)
    record.wait_for("Recording...")
    partner.talk(range(50))
    record.wait_for("Recorded 50 messages")
    assert record.end(signal.SIGINT) == 0
    assert numbers(tmp_path / "bag") == list(range(50))
    play = ros2_bag("play", "bag", "--loop", prepare=ignore)
    play.wait_for("Playback until")
    assert play.end(signal.SIGINT) == 0


def test_a_full_disk_ends_the_recording_with_a_word(ros2_bag, partner, tmp_path):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    record = ros2_bag("record", "--topics", "/chatter", "-o", "bag", prepare=limit)
    record.wait_for("Recording...")
    partner.talk(range(100))
    assert _polled(lambda: _count(tmp_path / "bag") == 100)
    partner.talk(range(100, 5000))
    assert record.finish() == 1
    assert "bag_0.mcap: cannot be written: File too large" in record.text
    assert "Traceback" not in record.text
    assert numbers(tmp_path / "bag") == list(range(100))


def test_a_bag_that_others_wrote_is_played(ros2_bag, partner, shared_data):
    from sensor_msgs.msg import LaserScan

    received = []
    partner.node.create_subscription(LaserScan, "/scan", received.append, 1000)
    clocks = []
    from rosgraph_msgs.msg import Clock

    partner.node.create_subscription(Clock, "/clock", clocks.append, 1000)
    play = ros2_bag("play", shared_data / "slam" / "intel", "--rate", "1000", "--clock", "100", "--topics", "/scan")
    assert play.finish() == 0
    assert _polled(lambda: len(received) == 910)
    assert len(received[-1].ranges) == 180
    assert len(clocks) > 50
    assert clocks[-1].clock.sec - clocks[0].clock.sec > 2000


def test_a_burst_then_the_rest_by_key(ros2_bag, partner, tmp_path):
    write_bag(tmp_path / "bag", 30)
    partner.listen()
    burst = ros2_bag("burst", "bag", "-n", "20", terminal=True)
    burst.wait_for("Burst 20 messages.")
    assert partner.wait_for(20) == list(range(20))
    burst.press(" ")
    assert burst.finish() == 0
    assert partner.wait_for(30) == list(range(30))


def test_again_and_again_until_ctrl_c(ros2_bag, partner, tmp_path):
    write_bag(tmp_path / "bag", 10)
    partner.listen()
    play = ros2_bag("play", "bag", "--loop", "--start-offset", "0.05")
    assert partner.wait_for(15)[:15] == [5, 6, 7, 8, 9] * 3
    assert play.end() == 0
    assert "Traceback" not in play.text


def test_overrides_of_quality_of_service(ros2_bag, partner, env, tmp_path):
    write_bag(tmp_path / "bag", 10)
    (tmp_path / "qos.yaml").write_text("/chatter:\n  durability: transient_local\n  depth: 100\n")
    play = ros2_bag("play", "bag", "--qos-profile-overrides-path", "qos.yaml", "--start-paused")
    play.wait_for("Overriding QoS profile for topic /chatter")
    play.wait_for("Playback until")
    graph = partner.node.handle.graph
    assert graph.wait_for(lambda: bool(graph.endpoints(name="/chatter")), 20)
    offered = graph.endpoints(name="/chatter")[0].qos
    assert (offered.transient_local, offered.depth) == (True, 100)
    assert play.end() == 0


def test_types_that_are_not_installed_are_passed_on(ros2_bag, partner, env, tmp_path):
    from rosbag2_py._types import opaque_class

    kind = opaque_class("no_such_msgs/msg/Thing", "RIHS01_" + "ab" * 32)
    record = ros2_bag("record", "-o", "bag", "--topics", "/thing", terminal=True)
    record.wait_for("Recording...")
    publisher = partner.node.create_publisher(kind, "/thing", 10)
    record.wait_for("Topic '/thing' has an unknown type 'no_such_msgs/msg/Thing' associated")
    assert partner.node.handle.graph.wait_for(lambda: publisher.get_subscription_count() > 0, 40)
    publisher.publish(b"\0\1\0\0hello")
    record.wait_for("Recorded 1 messages")
    assert record.end() == 0
    received = []
    partner.node.create_subscription(kind, "/again", received.append, 10, raw=True)
    play = ros2_bag("play", "bag", "-m", "/thing:=/again")
    assert play.finish() == 0
    assert "its type 'no_such_msgs/msg/Thing' is not installed" in play.text
    assert _polled(lambda: received == [b"\0\1\0\0hello"])
    shown = ros2("bag", "info", "bag", env=env, cwd=tmp_path)
    assert "Topic: /thing | Type: no_such_msgs/msg/Thing | Count: 1" in shown.out
