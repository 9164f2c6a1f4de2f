"""A server of interactive markers beside what clients are told, and menus."""

from types import SimpleNamespace

import pytest
import rclpy
from geometry_msgs.msg import Point, Pose
from interactive_markers import InteractiveMarkerServer, MenuHandler
from rclpy.time import Time
from std_msgs.msg import Header
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerFeedback, InteractiveMarkerUpdate, MenuEntry
from visualization_msgs.srv import GetInteractiveMarkers

FEEDBACK = InteractiveMarkerFeedback


class Client:
    """What RViz keeps of a server's markers."""

    def __init__(self, node):
        self.node, self.markers, self.updates = node, {}, []
        node.create_subscription(InteractiveMarkerUpdate, "controls/update", self._update, 100)
        self._feedback = node.create_publisher(FEEDBACK, "controls/feedback", 10)
        self._get = node.create_client(GetInteractiveMarkers, "controls/get_interactive_markers")

    def _update(self, message):
        self.updates.append(message)
        self.markers |= {marker.name: marker for marker in message.markers}
        for moved in message.poses:
            self.markers[moved.name].pose, self.markers[moved.name].header = moved.pose, moved.header
        for name in message.erases:
            del self.markers[name]

    def wait_for(self, condition):
        for _ in range(100):
            if condition():
                return
            rclpy.spin_once(self.node, timeout_sec=0.1)
        pytest.fail("it did not happen")

    def updates_come(self, count=1):
        goal = len(self.updates) + count
        self.wait_for(lambda: len(self.updates) >= goal)

    def all_markers(self):
        future = self._get.call_async(GetInteractiveMarkers.Request())
        self.wait_for(future.done)
        return future.result()

    def do(self, name, event=FEEDBACK.POSE_UPDATE, **fields):
        """Do something with a marker; the server hears it when it runs its next callback."""
        self._feedback.publish(FEEDBACK(marker_name=name, event_type=event, client_id="rviz", **fields))
        rclpy.spin_once(self.node, timeout_sec=5.0)


@pytest.fixture
def client(node):
    return Client(node)


@pytest.fixture
def server(node, client):
    return InteractiveMarkerServer(node, "controls")


def marker(name, x=0.0):
    return InteractiveMarker(name=name, header=Header(frame_id="map"), pose=at(x))


def at(x):
    return Pose(position=Point(x=x))


def test_clients_are_told_of_changes_when_they_are_applied(server, client):
    box = marker("box", 1.0)
    server.insert(box)
    server.insert(marker("ball", 2.0))
    box.pose.position.x = 99.0
    assert (server.get("box").pose, server.getNames()) == (at(1.0), [])
    server.applyChanges()
    client.updates_come()
    assert {name: held.pose for name, held in client.markers.items()} == {"box": at(1.0), "ball": at(2.0)}

    assert server.setPose("box", at(3.0))
    assert server.setPose("ball", at(4.0), Header(frame_id="odom"))
    assert server.get("box").pose == at(3.0)
    assert client.markers["box"].pose == at(1.0)
    server.applyChanges()
    client.updates_come()
    assert [update.seq_num for update in client.updates] == [1, 2]
    assert {update.server_id for update in client.updates} == {"/tested/controls"}
    assert (client.updates[1].markers, len(client.updates[1].poses)) == ([], 2)
    assert (client.markers["box"].pose, client.markers["box"].header.frame_id) == (at(3.0), "map")
    assert (client.markers["ball"].pose, client.markers["ball"].header.frame_id) == (at(4.0), "odom")

    assert server.erase("box")
    assert server.get("box") is None
    assert not server.setPose("box", at(0.0))
    server.applyChanges()
    client.updates_come()
    assert list(client.markers) == ["ball"] == server.getNames()


def test_no_changes_are_no_update(server, client):
    server.applyChanges()
    server.insert(marker("box"))
    assert server.erase("box")
    assert not server.erase("box")
    server.applyChanges()
    assert server.sequence_number == 0
    assert client.all_markers().markers == []


def test_a_new_client_gets_all_markers(server, client):
    server.insert(marker("box", 1.0))
    server.applyChanges()
    server.setPose("box", at(2.0))
    answer = client.all_markers()
    assert (answer.sequence_number, [held.pose for held in answer.markers]) == (1, [at(1.0)])
    server.applyChanges()
    answer = client.all_markers()
    assert (answer.sequence_number, [held.pose for held in answer.markers]) == (2, [at(2.0)])


def test_what_changes_before_it_was_applied_is_one_change(server, client):
    server.insert(marker("box", 1.0))
    server.setPose("box", at(2.0))
    server.applyChanges()
    client.updates_come()
    assert [held.pose for held in client.updates[0].markers] == [at(2.0)]
    server.setPose("box", at(3.0))
    server.clear()
    server.insert(marker("box", 4.0))
    server.applyChanges()
    client.updates_come()
    assert (client.updates[1].poses, client.updates[1].erases) == ([], [])
    assert client.markers["box"].pose == at(4.0)


def test_what_people_do_is_told(server, client):
    every, clicks = [], []
    server.insert(marker("box"), feedback_callback=every.append)
    assert server.setCallback("box", clicks.append, FEEDBACK.BUTTON_CLICK)
    assert not server.setCallback("nothing", clicks.append)
    server.applyChanges()
    client.updates_come()
    client.do("box", pose=at(5.0), header=Header(frame_id="camera"))
    client.do("box", FEEDBACK.BUTTON_CLICK)
    client.do("nothing", FEEDBACK.BUTTON_CLICK)
    client.do("box", FEEDBACK.MOUSE_UP)
    assert [feedback.event_type for feedback in every] == [FEEDBACK.POSE_UPDATE, FEEDBACK.MOUSE_UP]
    assert [feedback.marker_name for feedback in clicks] == ["box"]
    # A marker without a stamp keeps its frame.
    assert (server.get("box").pose, server.get("box").header.frame_id) == (at(5.0), "map")
    server.applyChanges()
    client.updates_come()
    assert client.markers["box"].pose == at(5.0)

    assert server.setCallback("box", None, FEEDBACK.BUTTON_CLICK)
    client.do("box", FEEDBACK.BUTTON_CLICK)
    assert (len(every), len(clicks)) == (3, 1)


def test_a_stamped_marker_takes_over_the_frame_of_what_moved_it(server):
    stamped = marker("box")
    stamped.header.stamp.sec = 5
    server.insert(stamped)
    server.applyChanges()
    server.processFeedback(
        FEEDBACK(marker_name="box", event_type=FEEDBACK.POSE_UPDATE, header=Header(frame_id="camera"), pose=at(1.0))
    )
    assert server.get("box").header.frame_id == "camera"


def test_two_people_do_not_pull_at_one_marker(server, node, monkeypatch):
    now = [0]
    clock = SimpleNamespace(now=lambda: Time(nanoseconds=now[0]))
    monkeypatch.setattr(node, "get_clock", lambda: clock)
    received = []
    server.insert(
        marker("box"), feedback_callback=lambda feedback: received.append((now[0] // 10**8, feedback.client_id))
    )
    server.applyChanges()
    for tenths, client_id in ((0, "a"), (5, "b"), (8, "a"), (17, "b"), (19, "b"), (20, "a")):
        now[0] = tenths * 10**8
        server.processFeedback(FEEDBACK(marker_name="box", client_id=client_id))
    assert received == [(0, "a"), (8, "a"), (19, "b")]


def test_a_marker_that_is_replaced_keeps_its_callbacks(server):
    received = []
    server.insert(marker("box"), feedback_callback=received.append)
    server.applyChanges()
    server.insert(marker("box", 1.0))
    server.applyChanges()
    server.processFeedback(FEEDBACK(marker_name="box"))
    assert len(received) == 1


def test_a_server_takes_its_markers_along(server, client, node):
    server.insert(marker("box"))
    server.applyChanges()
    client.updates_come()
    server.shutdown()
    client.wait_for(lambda: client.markers == {})
    server.shutdown()
    assert node.count_publishers("controls/update") == 0


def test_menus(server, client):
    chosen = []
    menu = MenuHandler()
    first = menu.insert("First", callback=lambda feedback: chosen.append(menu.getTitle(feedback.menu_entry_id)))
    sub = menu.insert("Modes")
    fast = menu.insert("Fast", parent=sub, callback=lambda feedback: chosen.append("fast"))
    hidden = menu.insert("Hidden", parent=sub)
    menu.insert("Below hidden", parent=hidden)
    help_ = menu.insert("Help", command_type=MenuEntry.ROSRUN, command="rviz2 rviz2")
    assert menu.insert("Nowhere", parent=77) is None
    assert menu.setCheckState(fast, MenuHandler.CHECKED)
    assert menu.setVisible(hidden, False)
    assert not menu.setVisible(77, True)
    assert not menu.setCheckState(77, MenuHandler.CHECKED)
    assert (menu.getCheckState(fast), menu.getCheckState(first)) == (MenuHandler.CHECKED, MenuHandler.NO_CHECKBOX)
    assert (menu.getCheckState(77), menu.getTitle(77)) == (None, None)

    for name in ("box", "ball"):
        server.insert(marker(name))
        assert menu.apply(server, name)
    assert not menu.apply(server, "nothing")
    server.applyChanges()
    client.updates_come()
    entries = client.markers["box"].menu_entries
    assert [(entry.id, entry.parent_id, entry.title) for entry in entries] == [
        (first, 0, "First"),
        (sub, 0, "Modes"),
        (fast, sub, "[x] Fast"),
        (help_, 0, "Help"),
    ]
    assert (entries[-1].command_type, entries[-1].command) == (MenuEntry.ROSRUN, "rviz2 rviz2")
    assert client.markers["ball"].menu_entries == entries

    for entry in (first, fast, sub, 77):
        client.do("box", FEEDBACK.MENU_SELECT, menu_entry_id=entry)
    assert chosen == ["First", "fast"]

    menu.setCheckState(fast, MenuHandler.UNCHECKED)
    server.erase("ball")
    assert not menu.reApply(server)
    assert menu.reApply(server)
    server.applyChanges()
    client.updates_come()
    assert client.markers["box"].menu_entries[2].title == "[ ] Fast"
