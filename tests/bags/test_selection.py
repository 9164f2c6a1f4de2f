import pytest

from daidalos.bags.selection import Selection, absolute

STRING, EVENT = "std_msgs/msg/String", "example_interfaces/srv/AddTwoInts_Event"
THERE = {
    "/chatter": STRING,
    "/robot/scan": "sensor_msgs/msg/LaserScan",
    "/robot/odom": "nav_msgs/msg/Odometry",
    "/_hidden": STRING,
    "/add/_service_event": EVENT,
    "/robot/add/_service_event": EVENT,
}


@pytest.mark.parametrize(
    ("selection", "wanted"),
    [
        (Selection(), []),
        (Selection(all_topics=True), ["/chatter", "/robot/scan", "/robot/odom"]),
        (Selection(all_topics=True, hidden=True), ["/chatter", "/robot/scan", "/robot/odom", "/_hidden"]),
        (Selection(all_services=True), ["/add/_service_event", "/robot/add/_service_event"]),
        (Selection(topics=("/chatter", "/_hidden")), ["/chatter", "/_hidden"]),
        (Selection(services=("/add",)), ["/add/_service_event"]),
        (Selection(types=(STRING,)), ["/chatter"]),
        (Selection(regex="^/robot"), ["/robot/scan", "/robot/odom", "/robot/add/_service_event"]),
        (Selection(regex="o", all_topics=True), ["/chatter", "/robot/scan", "/robot/odom"]),
        (Selection(regex="chat", topics=("/robot/scan",)), ["/chatter", "/robot/scan"]),
        (Selection(all_topics=True, exclude_regex="robot|nothing"), ["/chatter"]),
        (Selection(all_topics=True, exclude_topics=("/chatter",)), ["/robot/scan", "/robot/odom"]),
        (Selection(all_topics=True, exclude_types=(STRING,)), ["/robot/scan", "/robot/odom"]),
        (Selection(all_services=True, exclude_services=("/add",)), ["/robot/add/_service_event"]),
        (Selection(all_services=True, exclude_regex="robot"), ["/add/_service_event"]),
    ],
)
def test_what_is_wanted(selection, wanted):
    assert [name for name, kind in THERE.items() if selection.wants(name, kind)] == wanted


def test_what_is_wanted_may_be_known_beforehand():
    assert Selection(topics=("/a",), services=("/b",)).names == ("/a", "/b/_service_event")
    assert Selection(topics=("/a",), regex="b").names is None
    assert absolute(["a", "/b"]) == ("/a", "/b")
    assert absolute(None) == ()


@pytest.mark.parametrize("name", ["regex", "exclude_regex"])
def test_what_is_no_regular_expression(name):
    with pytest.raises(ValueError, match=r"invalid regular expression 'a\(': .* at position 1"):
        Selection(**{name: "a("}).check()
