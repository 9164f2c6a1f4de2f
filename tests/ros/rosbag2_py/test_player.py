import threading
import time
from itertools import pairwise

import pytest
from example_interfaces.srv import AddTwoInts
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rosbag2_interfaces import srv
from rosbag2_interfaces.msg import ReadSplitEvent
from rosbag2_py import Player, PlayOptions, ServiceRequestsSource, StorageOptions
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from daidalos.bags.message import BagMessage, Topic
from daidalos.bags.writer import BagWriter
from ros.graph import spinning

from .conftest import SECOND, write_chatter

TIMEOUT_S = 20
QUIET = {"disable_keyboard_controls": True, "progress_bar_update_rate": 0}


class Received:
    """What a node hears on a topic."""

    def __init__(self, node, topic="/chatter", kind=String, field=lambda message: int(message.data)):
        self.values = []
        self.times = []
        self._changed = threading.Condition()
        self._field = field
        node.create_subscription(kind, topic, self._take, QoSProfile(depth=1000))

    def _take(self, message):
        with self._changed:
            self.values.append(self._field(message))
            self.times.append(time.monotonic())
            self._changed.notify_all()

    def wait_for(self, count):
        with self._changed:
            assert self._changed.wait_for(lambda: len(self.values) >= count, TIMEOUT_S), self.values
        return self.values


def play(uri, **options):
    player = Player(StorageOptions(uri), PlayOptions(**QUIET, **options), "warn")
    try:
        player.play_sync()
    finally:
        player.stop_spin()


def test_everything_comes_in_order_and_in_time(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 40)
    received = Received(node)
    with spinning(node):
        play(uri)
        assert received.wait_for(40) == list(range(40))
    assert 0.35 < received.times[-1] - received.times[0] < 1.5


def test_faster(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 100, period_ns=100_000_000)
    received = Received(node)
    with spinning(node):
        play(uri, rate=100.0)
        assert received.wait_for(100) == list(range(100))
    assert received.times[-1] - received.times[0] < 5.0


def test_a_part(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 100)
    received = Received(node)
    with spinning(node):
        play(uri, start_offset=0.5, playback_duration=0.1, rate=10.0)
        assert received.wait_for(11) == list(range(50, 61))
        play(uri, playback_until_timestamp=SECOND + 30_000_000)
        assert received.wait_for(15)[11:] == [0, 1, 2, 3]
        play(uri, playback_until_timestamp=5)
        play(uri, start_offset=1000.0)
        assert len(received.values) == 15


def test_other_names_and_only_some_topics(node, tmp_path):
    topics = [Topic(name, "std_msgs/msg/String") for name in ("/a", "/b", "/c")]
    data = b"\0\1\0\0\2\0\0\0007\0\0\0"
    with BagWriter(tmp_path / "bag") as bag:
        for topic in topics:
            bag.add_topic(topic)
            bag.write(BagMessage(topic.name, data, 1, 1))
    received = {name: Received(node, name) for name in ("/a", "/b", "/c", "/d")}
    with spinning(node):
        options = {"topic_remapping_options": ["--ros-args", "--remap", "/a:=/d"]}
        play(str(tmp_path / "bag"), exclude_topics_to_filter=["/c"], **options)
        received["/b"].wait_for(1)
        received["/d"].wait_for(1)
        play(str(tmp_path / "bag"), topics_to_filter=["c"])
        received["/c"].wait_for(1)
        play(str(tmp_path / "bag"), regex_to_filter="[ab]", exclude_regex_to_filter="b")
        received["/a"].wait_for(1)
    assert {name: len(one.values) for name, one in received.items()} == {"/a": 1, "/b": 1, "/c": 1, "/d": 1}


@pytest.mark.slow
def test_the_clock(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 50)

    def clock():
        return Received(node, "/clock", Clock, lambda message: message.clock.sec * SECOND + message.clock.nanosec)

    received = clock()
    with spinning(node):
        play(uri, clock_publish_frequency=100.0)
        regular = list(received.wait_for(20))
        with_messages = clock()  # which hears nothing of what is still on its way to the other
        play(uri, clock_topics=["chatter"], rate=10.0)
        assert with_messages.wait_for(50) == [SECOND + k * 10_000_000 for k in range(50)]
    assert regular == sorted(regular)
    assert SECOND <= regular[0] < regular[-1] <= SECOND + 700_000_000
    steps = [after - before for before, after in pairwise(regular)]
    assert 5_000_000 < sorted(steps)[len(steps) // 2] < 20_000_000


def test_several_bags_in_one_order(node, tmp_path):
    first = write_chatter(tmp_path / "first", 20)
    other = write_chatter(tmp_path / "other", 5, "sqlite3", period_ns=45_000_000)
    received = Received(node)
    player = Player([StorageOptions(first), StorageOptions(other)], PlayOptions(**QUIET, rate=10.0), "warn")
    with spinning(node):
        player.play_sync()
        received.wait_for(25)
        player.stop_spin()
    times = sorted([(k * 10, 0, k) for k in range(20)] + [(k * 45, 1, k) for k in range(5)])
    assert received.values == [number for _, _, number in times]


def test_files_that_change_are_told(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 50, max_bagfile_duration=0.2)
    events = Received(node, "/events/read_split", ReadSplitEvent, lambda one: (one.closed_file, one.opened_file))
    with spinning(node):
        play(uri, rate=10.0)
        closed, opened = events.wait_for(1)[0]
    assert closed.endswith("bag_0.mcap")
    assert opened.endswith("bag_1.mcap")


@pytest.fixture
def paused(node, tmp_path):
    """A player that stands still at the beginning of 20 messages, what is heard, and how to call it."""
    uri = write_chatter(tmp_path / "bag", 20)
    received = Received(node)
    player = Player(StorageOptions(uri), PlayOptions(start_paused=True, **QUIET), "warn")

    def call(kind, name, **fields):
        client = node.create_client(kind, f"/rosbag2_player/{name}")
        assert client.wait_for_service(TIMEOUT_S)
        return client.call(kind.Request(**fields), timeout_sec=TIMEOUT_S)

    with spinning(node):
        player.start_spin()
        player.start_spin()
        player.play()
        try:
            yield player, received, call
        finally:
            player.stop()
            player.stop_spin()


def test_step_by_step(paused):
    player, received, _ = paused
    assert player.is_paused()
    assert player.play_next()
    assert player.play_next()
    assert received.wait_for(2) == [0, 1]
    assert player.burst(3) == 3
    assert received.wait_for(5) == [0, 1, 2, 3, 4]
    player.seek(SECOND + 150_000_000)
    assert player.play_next()
    assert received.wait_for(6)[-1] == 15
    player.resume()
    assert not player.play_next()
    assert player.burst(1) == 0
    assert player.wait_for_playback_to_finish(TIMEOUT_S)
    assert received.wait_for(10)[6:] == [16, 17, 18, 19]
    assert player.error is None


def test_control_by_services(paused):
    player, received, call = paused
    assert call(srv.IsPaused, "is_paused").paused
    assert call(srv.PlayNext, "play_next").success
    assert call(srv.Burst, "burst", num_messages=4).actually_burst == 4
    assert received.wait_for(5) == [0, 1, 2, 3, 4]
    request = srv.Seek.Request()
    request.time.sec, request.time.nanosec = 1, 100_000_000
    assert call(srv.Seek, "seek", time=request.time).success
    assert call(srv.Burst, "burst", num_messages=0).actually_burst == 10
    assert received.wait_for(15)[5:] == list(range(10, 20))
    assert player.wait_for_playback_to_finish(TIMEOUT_S)
    assert not call(srv.PlayNext, "play_next").success
    assert not call(srv.Seek, "seek", time=request.time).success


def test_speed_and_pausing_by_services(paused):
    player, _, call = paused
    assert call(srv.SetRate, "set_rate", rate=5.0).success
    assert not call(srv.SetRate, "set_rate", rate=0.0).success
    assert call(srv.GetRate, "get_rate").rate == 5.0
    call(srv.TogglePaused, "toggle_paused")
    assert not player.is_paused()
    call(srv.Pause, "pause")
    assert player.is_paused()
    call(srv.Resume, "resume")
    assert player.wait_for_playback_to_finish(TIMEOUT_S)


def test_a_part_by_service(paused):
    player, received, call = paused
    assert not call(srv.Play, "play").success
    call(srv.Stop, "stop")
    player.resume()
    request = srv.Play.Request()
    request.start_offset.nanosec = 100_000_000
    request.playback_duration.nanosec = 20_000_000
    request.playback_until_timestamp.sec = -1
    assert call(
        srv.Play,
        "play",
        start_offset=request.start_offset,
        playback_duration=request.playback_duration,
        playback_until_timestamp=request.playback_until_timestamp,
    ).success
    assert player.wait_for_playback_to_finish(TIMEOUT_S)
    assert received.wait_for(3) == [10, 11, 12]


def test_again_and_again_until_it_is_cancelled(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 3)
    received = Received(node)
    with spinning(node):
        thread = threading.Thread(target=play, args=(uri,), kwargs={"loop": True}, daemon=True)
        thread.start()
        assert received.wait_for(9)[:9] == [0, 1, 2] * 3
        Player.cancel()
        thread.join(TIMEOUT_S)
        assert not thread.is_alive()


def test_a_loop_over_nothing_ends(graph, tmp_path):
    play(write_chatter(tmp_path / "bag", 0), loop=True)


def test_a_bag_that_is_damaged_plays_up_to_there(node, tmp_path):
    uri = write_chatter(tmp_path / "bag", 20, max_bagfile_duration=0.1)
    file = tmp_path / "bag" / "bag_1.mcap"
    data = bytearray(file.read_bytes())
    data[data.index(b"\0\1\0\0\3\0\0\0") + 8] ^= 255
    file.write_bytes(data)
    received = Received(node)
    with spinning(node):
        with pytest.raises(RuntimeError, match=r"bag_1\.mcap: the chunk at byte \d+ is damaged"):
            play(uri)
        assert received.wait_for(11) == list(range(11))


def test_types_that_are_not_known(node, tmp_path, capfd):
    with BagWriter(tmp_path / "bag") as bag:
        for topic in (
            Topic("/lost", "no_such_msgs/msg/Thing"),
            Topic("/passed_on", "no_such_msgs/msg/Thing", type_hash="RIHS01_" + "ab" * 32),
            Topic("/other", "std_msgs/msg/String", type_hash="RIHS01_" + "cd" * 32),
            Topic("/json", "std_msgs/msg/String", "json"),
        ):
            bag.add_topic(topic)
            bag.write(BagMessage(topic.name, b"\0\1\0\0\2\0\0\0007\0\0\0", 1, 1))
    player = Player(StorageOptions(str(tmp_path / "bag")), PlayOptions(start_paused=True, **QUIET), "warn")
    player.start_spin()
    player.play()
    offered = {
        one.name: (one.type_name, one.type_hash)
        for one in node.handle.graph.endpoints()
        if one.node.name == "rosbag2_player" and one.name in ("/lost", "/passed_on", "/other", "/json")
    }
    player.stop()
    player.stop_spin()
    assert offered == {
        "/passed_on": ("no_such_msgs/msg/Thing", "RIHS01_" + "ab" * 32),
        "/other": ("std_msgs/msg/String", "RIHS01_" + "cd" * 32),
    }
    said = capfd.readouterr().err
    assert "Ignoring a topic '/lost', reason: the type 'no_such_msgs/msg/Thing' is not known" in said
    assert "'no_such_msgs/msg/Thing' is not installed; its messages are passed on as they were recorded" in said
    assert "'std_msgs/msg/String' is defined otherwise here" in said
    assert "its serialization format is 'json'" in said


def test_options_that_make_no_sense(graph, tmp_path):
    uri = write_chatter(tmp_path / "bag", 1)
    with pytest.raises(RuntimeError, match="'xxx' is not a severity"):
        Player(StorageOptions(uri), PlayOptions(**QUIET), "xxx")
    with pytest.raises(RuntimeError, match="no such file or folder"):
        Player(StorageOptions(str(tmp_path / "nowhere")), PlayOptions(**QUIET))
    with pytest.raises(ValueError, match="rate: expected a number above 0"):
        Player(StorageOptions(uri), PlayOptions(rate=0.0, **QUIET))
    player = Player()
    for method in (player.start_spin, player.play, player.stop, player.play_next, player.play_sync, player.pause):
        with pytest.raises(RuntimeError, match="not configured"):
            method()
    with pytest.raises(RuntimeError, match="not configured"):
        player.burst(1)
    with pytest.raises(RuntimeError, match="Expected a bag to play, found none"):
        Player([], PlayOptions(**QUIET))


def call_events(folder):
    """Write a bag with the events of two calls, as a client (0, 3) and its service (1, 2) tell of them."""
    event_class = AddTwoInts.Event
    type_name = "example_interfaces/srv/AddTwoInts_Event"
    topic = Topic("/add/_service_event", type_name, type_hash=event_class._TYPE_HASH)
    with BagWriter(folder) as bag:
        bag.add_topic(topic)
        for number in (1, 2):
            for kind in (0, 1, 2, 3):
                event = event_class()
                event.info.event_type = kind
                event.info.sequence_number = number
                if kind in (0, 1):
                    event.request = [AddTwoInts.Request(a=number, b=10 * kind)]
                time_ns = SECOND + number * 10_000_000 + kind
                bag.write(BagMessage(topic.name, serialize_message(event), time_ns, time_ns))
    return str(folder)


@pytest.mark.parametrize(
    ("source", "sums"),
    [(ServiceRequestsSource.SERVICE_INTROSPECTION, [11, 12]), (ServiceRequestsSource.CLIENT_INTROSPECTION, [1, 2])],
)
def test_requests_are_sent_again(node, tmp_path, source, sums):
    uri = call_events(tmp_path / "bag")
    served, done = [], threading.Event()

    def serve(request, response):
        served.append(request.a + request.b)
        if len(served) == 2:
            done.set()
        return response

    node.create_service(AddTwoInts, "/add", serve)
    with spinning(node):
        play(uri, publish_service_requests=True, service_requests_source=source)
        assert done.wait(TIMEOUT_S)
    assert served == sums


def test_events_of_services_are_published_as_they_were(node, tmp_path):
    uri = call_events(tmp_path / "bag")
    kinds = Received(node, "/add/_service_event", AddTwoInts.Event, lambda event: event.info.event_type)
    with spinning(node):
        play(uri)
        assert kinds.wait_for(8) == [0, 1, 2, 3] * 2
        play(uri, services_to_filter=["/other"])
        play(uri, exclude_service_events_to_filter=["/add"])
        play(uri, services_to_filter=["add"])
        assert kinds.wait_for(16) == [0, 1, 2, 3] * 4
