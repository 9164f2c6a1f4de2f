import threading
from datetime import timedelta

import pytest
import rosbag2_py
from example_interfaces.srv import AddTwoInts
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rosbag2_interfaces import srv
from rosbag2_interfaces.msg import WriteSplitEvent
from rosbag2_py import Recorder, RecordOptions, SequentialReader, StorageOptions
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Int32, String

from ros.graph import spinning

TIMEOUT_S = 20


class Recording:
    """A recorder that runs, and a way to wait for what it wrote."""

    def __init__(self, folder, storage=None, **options):
        self.folder = folder
        options = {"disable_keyboard_controls": True, "topic_polling_interval": timedelta(milliseconds=10), **options}
        self.recorder = Recorder(storage or StorageOptions(str(folder)), RecordOptions(**options), "warn")

    def __enter__(self):
        self.recorder.start_spin()
        self.recorder.start_spin()
        self.recorder.record()
        return self

    def __exit__(self, *error):
        self.recorder.stop()
        self.recorder.stop_spin()

    def wait_for(self, node, *topics):
        graph = node.handle.graph
        for topic in topics:
            assert graph.wait_for(
                lambda topic=topic: any(
                    one.node.name == "rosbag2_recorder" and one.kind.value == "subscription"
                    for one in graph.endpoints(name=topic)
                ),
                TIMEOUT_S,
            ), topic


def content(folder):
    reader = SequentialReader()
    reader.open_uri(str(folder))
    found = {one.name: 0 for one in reader.get_all_topics_and_types()}
    while reader.has_next():
        found[reader.read_next()[0]] += 1
    return found


def test_topics_are_recorded_as_they_appear(node, tmp_path, storage):
    early = node.create_publisher(String, "/early", 10)
    with Recording(tmp_path / "bag", StorageOptions(str(tmp_path / "bag"), storage), all_topics=True) as recording:
        recording.wait_for(node, "/early")
        late = node.create_publisher(Int32, "/late", 10)
        node.create_publisher(Int32, "/_hidden", 10)
        node.create_subscription(String, "/nobody", lambda message: None, 10)
        recording.wait_for(node, "/late")
        for k in range(50):
            early.publish(String(data=str(k)))
            late.publish(Int32(data=k))
    found = content(tmp_path / "bag")
    assert (found["/early"], found["/late"]) == (50, 50)
    assert not {"/_hidden", "/nobody"} & set(found)


def test_only_what_is_wanted(node, tmp_path):
    publishers = [node.create_publisher(String, name, 10) for name in ("/robot/a", "/robot/b", "/c")]
    options = {"regex": "robot", "exclude_topics": ["/robot/b"]}
    with Recording(tmp_path / "bag", **options) as recording:
        recording.wait_for(node, "/robot/a")
        for publisher in publishers:
            publisher.publish(String())
    assert content(tmp_path / "bag") == {"/robot/a": 1}


def test_late_samples_are_asked_for_where_all_publishers_keep_them(node, tmp_path):
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_publisher(String, "/map", latched).publish(String(data="map"))
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    scan = node.create_publisher(String, "/scan", best_effort)
    mixed = [node.create_publisher(String, "/mixed", one) for one in (best_effort, latched)]
    with Recording(tmp_path / "bag", topics=["map", "/scan", "/mixed"]) as recording:
        recording.wait_for(node, "/map", "/scan", "/mixed")
        for publisher in (scan, *mixed):
            publisher.publish(String())
    assert content(tmp_path / "bag") == {"/map": 1, "/scan": 1, "/mixed": 2}
    metadata = rosbag2_py.MetadataIo().read_metadata(str(tmp_path / "bag"))
    profiles = {
        one.topic_metadata.name: one.topic_metadata.offered_qos_profiles for one in metadata.topics_with_message_count
    }
    assert profiles["/map"][0].profile.transient_local
    assert [one.profile.reliable for one in profiles["/mixed"]] == [False, True]


def test_an_override_outweighs_what_is_offered(node, tmp_path, capfd):
    publisher = node.create_publisher(String, "/scan", QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT))
    with Recording(tmp_path / "bag", topics=["/scan"], topic_qos_profile_overrides={"/scan": QoSProfile(depth=1)}) as r:
        r.wait_for(node, "/scan")
        publisher.publish(String())
        other = node.create_publisher(Int32, "/other", 10)
        node.destroy_publisher(other)
    assert content(tmp_path / "bag") == {"/scan": 0}


def test_pausing_splitting_and_events(node, tmp_path):
    events, told = [], threading.Event()
    node.create_subscription(WriteSplitEvent, "/events/write_split", lambda one: (events.append(one), told.set()), 10)
    publisher = node.create_publisher(String, "/chatter", 10)
    with Recording(tmp_path / "bag", topics=["/chatter"]) as recording, spinning(node):
        recording.wait_for(node, "/chatter")

        def call(kind, name, **fields):
            client = node.create_client(kind, f"/rosbag2_recorder/{name}")
            assert client.wait_for_service(TIMEOUT_S)
            return client.call(kind.Request(**fields), timeout_sec=TIMEOUT_S)

        publisher.publish(String())
        assert wait_for_count(recording, 1)
        call(srv.Pause, "pause")
        assert call(srv.IsPaused, "is_paused").paused
        publisher.publish(String())
        assert call(srv.IsDiscoveryRunning, "is_discovery_running").running is False
        call(srv.Resume, "resume")
        call(srv.SplitBagfile, "split_bagfile")
        publisher.publish(String())
        assert told.wait(TIMEOUT_S)
        response = call(srv.Record, "record")
        assert (response.return_code, response.error_string) == (1, "Recording is already in progress.")
        call(srv.Stop, "stop")
        assert not recording.recorder.node.is_recording
        again = call(srv.Record, "record", uri=str(tmp_path / "again"))
        assert again.return_code == 0
        assert call(srv.Record, "record", uri=str(tmp_path / "again")).return_code == 1
    assert content(tmp_path / "bag") == {"/chatter": 2}
    assert content(tmp_path / "again") == {"/chatter": 0}
    assert len(rosbag2_py.MetadataIo().read_metadata(str(tmp_path / "bag")).files) == 2
    assert events[0].closed_file.endswith("bag_0.mcap")
    assert events[0].opened_file.endswith("bag_1.mcap")
    assert events[0].node_name == "/rosbag2_recorder"


def wait_for_count(recording, count):
    """Wait until the bag has so many messages."""
    ended = threading.Event()
    for _ in range(TIMEOUT_S * 100):
        if recording.recorder.node.bag.message_count >= count:
            return True
        ended.wait(0.01)
    return False


def test_snapshot_mode(node, tmp_path):
    publisher = node.create_publisher(String, "/chatter", 10)
    storage = StorageOptions(str(tmp_path / "bag"), max_cache_size=10**6, snapshot_mode=True)
    with Recording(tmp_path / "bag", storage, topics=["/chatter"]) as recording, spinning(node):
        recording.wait_for(node, "/chatter")
        client = node.create_client(srv.Snapshot, "/rosbag2_recorder/snapshot")
        assert client.wait_for_service(TIMEOUT_S)
        assert client.call(srv.Snapshot.Request(), timeout_sec=TIMEOUT_S).success is False
        for _ in range(5):
            publisher.publish(String())
        # The recorder's callbacks run in order: the request is served after the messages came.
        assert client.call(srv.Snapshot.Request(), timeout_sec=TIMEOUT_S).success
        publisher.publish(String())
    assert content(tmp_path / "bag") == {"/chatter": 5}


def test_recording_until_it_is_cancelled(node, tmp_path):
    publisher = node.create_publisher(String, "/chatter", 10)
    recorder = Recorder()
    options = RecordOptions(all_topics=True, disable_keyboard_controls=True)
    arguments = (StorageOptions(str(tmp_path / "bag")), options)
    thread = threading.Thread(target=recorder.record, args=arguments, daemon=True)
    thread.start()
    graph = node.handle.graph
    assert graph.wait_for(lambda: publisher.get_subscription_count() > 0, TIMEOUT_S)
    publisher.publish(String())
    Recorder.cancel()
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()
    assert content(tmp_path / "bag")["/chatter"] == 1


def test_a_recording_cancelled_before_it_starts_leaves_a_whole_bag(graph, tmp_path):
    recorder = Recorder()
    options = RecordOptions(all_topics=True, disable_keyboard_controls=True)
    recorder.cancel()
    recorder.record(StorageOptions(str(tmp_path / "first")), options)
    assert (tmp_path / "first" / "metadata.yaml").is_file()
    thread = threading.Thread(target=recorder.record, args=(StorageOptions(str(tmp_path / "second")), options))
    thread.start()
    thread.join(0.2)
    assert thread.is_alive(), "the first call of cancel ended one recording only"
    recorder.cancel()
    thread.join(TIMEOUT_S)
    assert not thread.is_alive()


def test_options_that_make_no_sense(graph, tmp_path):
    with pytest.raises(RuntimeError, match="'xxx' is not a severity"):
        Recorder(StorageOptions(str(tmp_path / "bag")), RecordOptions(), "xxx")
    with pytest.raises(ValueError, match="invalid regular expression"):
        Recorder(StorageOptions(str(tmp_path / "bag")), RecordOptions(regex="("))
    recorder = Recorder()
    for method in (recorder.start_spin, recorder.record, recorder.stop, recorder.pause, recorder.record_sync):
        with pytest.raises(RuntimeError, match="not configured"):
            method()
    (tmp_path / "bag").mkdir()
    options = RecordOptions(all_topics=True, disable_keyboard_controls=True)
    recorder = Recorder(StorageOptions(str(tmp_path / "bag")), options, "fatal")
    with pytest.raises(RuntimeError, match="already exists"):
        recorder.record_sync()
    recorder.stop_spin()
    options.all = False
    assert options.all is False


def test_simulated_time(node, tmp_path):
    publisher = node.create_publisher(String, "/chatter", 10)
    clock = node.create_publisher(Clock, "/clock", 10)
    with Recording(tmp_path / "bag", topics=["/chatter"], use_sim_time=True) as recording:
        recording.wait_for(node, "/chatter", "/clock")
        publisher.publish(String(data="too early"))
        recorder = recording.recorder.node
        waiting = recorder._subscribed["/chatter"].handle.impl
        while len(waiting):
            threading.Event().wait(0.01)
        message = Clock()
        message.clock.sec = 42
        for _ in range(TIMEOUT_S * 100):
            clock.publish(message)
            if recorder.get_clock().now().nanoseconds:
                break
            threading.Event().wait(0.01)
        publisher.publish(String(data="in time"))
        assert wait_for_count(recording, 1)
    reader = SequentialReader()
    reader.open_uri(str(tmp_path / "bag"))
    _, data, time = reader.read_next()
    assert (deserialize_message(data, String).data, time) == ("in time", 42_000_000_000)
    assert not reader.has_next()


def test_services_by_their_events(node, tmp_path):
    calls = node.create_publisher(AddTwoInts.Event, "/add/_service_event", 10)
    node.create_publisher(AddTwoInts.Event, "/sub/_service_event", 10)
    with Recording(tmp_path / "bag", services=["add"]) as recording:
        recording.wait_for(node, "/add/_service_event")
        calls.publish(AddTwoInts.Event())
    assert content(tmp_path / "bag") == {"/add/_service_event": 1}


def test_a_topic_of_two_types_is_told(node, tmp_path, capfd):
    node.create_publisher(String, "/both", 10)
    node.create_publisher(Int32, "/both", 10)
    one = node.create_publisher(Int32, "/one", 10)
    with Recording(tmp_path / "bag", topics=["/both", "/one"]) as recording:
        recording.wait_for(node, "/one")
        one.publish(Int32())
    assert content(tmp_path / "bag") == {"/one": 1}
    assert "Topic '/both' has more than one type associated" in capfd.readouterr().err
