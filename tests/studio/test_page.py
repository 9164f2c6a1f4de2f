"""The page in a real browser, against the real server and a robot that drives."""

import math
import queue
import time
from collections.abc import Iterator

import foxglove
import pytest

from browser.cdp import Chromium, require_chromium, require_page
from daidalos.studio.arrangement import Arrangement, Curve, Display, Plot, Split, View
from daidalos.studio.assets import AssetResolver
from daidalos.studio.plotjuggler_layout import parse_plotjuggler
from daidalos.studio.rviz_config import parse_rviz
from daidalos.studio.server import StudioServer

from . import display_zoo
from .demo_robot import SHARE, DemoRobot
from .memory_source import MemorySource, decode, encode, make, schema
from .test_plotjuggler_layout import LAYOUT
from .test_rviz_config import ROS_2

pytestmark = [pytest.mark.browser, pytest.mark.slow]

READY = "window.daidalos && daidalos.state().connected"
SEES = "daidalos.state().scanPoints > 700 && daidalos.state().maps.Map?.[0] === 160"


@pytest.fixture(scope="module", autouse=True)
def built_page() -> None:
    require_page()


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    require_chromium()
    with Chromium(1280, 800) as browser:
        yield browser


@pytest.fixture(autouse=True)
def left_page(browser: Chromium) -> Iterator[None]:
    """Leave the page after each test: it would ask for its server, which is gone, and the next test would be blamed."""
    yield
    browser.open("about:blank")


@pytest.fixture
def source() -> MemorySource:
    return MemorySource()


@pytest.fixture
def robot(source: MemorySource) -> Iterator[DemoRobot]:
    with DemoRobot(source) as robot:
        yield robot


def serve(source: MemorySource, port: int = 0, arrangement: Arrangement | None = None) -> StudioServer:
    assets = AssetResolver(lambda package: SHARE / package if (SHARE / package).is_dir() else None)
    return StudioServer(source, name="demo robot", port=port, assets=assets, arrangement=arrangement)


@pytest.fixture
def page(browser: Chromium, source: MemorySource, robot: DemoRobot) -> Iterator[Chromium]:
    with serve(source) as server:
        show(browser, server.url)
        browser.wait_for(SEES, 60)
        browser.wait_for("daidalos.state().settled")
        yield browser
        assert browser.errors == []


def show(browser: Chromium, url: str) -> None:
    """Open the page as someone who was never there."""
    browser.open("about:blank")
    browser.forget(url)
    browser.errors.clear()
    browser.open(url)
    browser.wait_for(READY, 60)


def at(page: Chromium, x: float, y: float) -> tuple[float, float]:
    """Where a point of the ground is in the window."""
    place = page.evaluate(f"daidalos.project({x}, {y})")
    return place["x"], place["y"]


def _distance_from_track(state, robot):
    """Return how far [m] the robot on the page is from where it was around the page's time."""
    pose = state["robotPose"]
    near = [(x, y) for time, x, y in robot.track[-3000:] if abs(time - state["time"]) < 1.0]
    return min(math.hypot(pose["x"] - x, pose["y"] - y) for x, y in near)


def test_shows_a_robot_without_anybodys_help(page, robot):
    page.wait_for("daidalos.state().displays.Robot.text === '11 links'", 60)
    shown = ["Robot", "Laser scan", "Map", "Plan", "TF", "Footprint", "markers"]
    page.wait_for(f"{shown}.every((name) => daidalos.state().displays[name]?.level === 'ok')")
    state = page.evaluate("daidalos.state()")
    assert state["serverName"] == "demo robot"
    assert state["fixedFrame"] == "map"
    assert {"map", "odom", "base_footprint", "base_scan", "wheel_left_link"} <= set(state["frames"])
    assert state["maps"]["Global costmap"] == [160, 160]
    assert state["maps"]["Local costmap"] == [60, 60]
    wrong = {name: each for name, each in state["displays"].items() if each["level"] in ("error", "warning")}
    assert wrong == {}
    assert 0 < state["time"] <= robot.now
    page.wait_for(f"daidalos.state().time >= {robot.now}")
    assert _distance_from_track(state, robot) < 0.05


@pytest.mark.parametrize("view", ["orbit", "top"])
def test_a_goal_that_is_dragged_with_the_mouse_is_driven_to(page, robot, view):
    if view == "top":
        page.press("t")
        page.wait_for("document.querySelector('[data-test=top-down]').ariaPressed === 'true'")
    goal = (round(robot.x + 0.4, 1), round(robot.y - 0.3, 1))
    page.click_on("[data-tool=goal]")
    page.wait_for("daidalos.state().tool === 'goal'")
    start, end = at(page, *goal), at(page, goal[0], goal[1] + 0.6)
    page.drag([start, ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), end])
    page.wait_for("daidalos.state().tool === 'move'")
    page.wait_for("daidalos.state().published['/goal_pose']")
    page.wait_for("daidalos.state().displays.Goal.level === 'ok'")
    ((x, y, yaw),) = robot.goals
    assert (x, y) == pytest.approx(goal, abs=0.02)
    assert yaw == pytest.approx(math.pi / 2, abs=0.05)
    near = f"Math.hypot(daidalos.state().robotPose.x - {x}, daidalos.state().robotPose.y - {y}) < 0.1"
    page.wait_for(f"{near} && Math.abs(daidalos.state().robotPose.yaw - {yaw}) < 0.1", 60)


def test_the_other_tools_publish_what_rviz_publishes(page, source):
    page.press("p")
    page.drag([at(page, 0.5, 0.5), at(page, 0.0, 0.5)])
    page.wait_for("daidalos.state().published['/initialpose']")
    page.press("u")
    page.click(*at(page, -0.5, 0.25))
    page.wait_for("daidalos.state().published['/clicked_point']")
    page.wait_for("daidalos.state().tool === 'move'")
    page.press("n")
    page.click(*at(page, -0.2, 0.1))  # within the robot's loop, where it does not come in between
    page.click(*at(page, 0.4, 0.1))
    page.wait_for("/Length 0.(59|60|61)/.test(document.querySelector('[data-test=hint]').textContent)")
    page.press("Escape")
    page.wait_for("daidalos.state().tool === 'move'")
    published = {topic: decode(type_name, payload) for topic, type_name, payload in source.published}
    pose = published["/initialpose"]
    assert pose.header.frame_id == "map"
    assert pose.pose.pose.position.x == pytest.approx(0.5, abs=0.02)
    assert abs(pose.pose.pose.orientation.z) == pytest.approx(1, abs=0.01)
    assert pose.pose.covariance[0] == 0.25
    assert pose.pose.covariance[35] == pytest.approx((math.pi / 12) ** 2)
    point = published["/clicked_point"].point
    assert (point.x, point.y) == pytest.approx((-0.5, 0.25), abs=0.02)


def place_of(page: Chromium, selector: str) -> dict[str, float]:
    """Return where an element is once it has been there for some frames, and the same element."""
    return page.evaluate(f"""new Promise((resolve) => {{
        let [last, same] = [undefined, 0];
        const look = () => {{
            const element = document.querySelector({selector!r});
            const {{ x, y, width, height }} = element.getBoundingClientRect();
            const now = [element, x, y, width, height];
            same = last?.every((value, i) => value === now[i]) ? same + 1 : 0;
            last = now;
            if (same < 10) requestAnimationFrame(look);
            else resolve({{ x, y, width, height }});
        }};
        look();
    }})""")


LEGEND = "[...document.querySelectorAll('.legend-name')].map((e) => e.textContent)"


def test_numbers_are_plotted_zoomed_and_read_under_the_mouse(page):
    page.click_on("[data-topic='/odom'] [data-test=fields]")
    page.wait_for("document.querySelector('.topic-fields [data-path]')")
    page.click_on("[data-path='/odom/pose/pose/position/x']")
    page.double_click_on("[data-path='/odom/pose/pose/position/x']")
    page.wait_for(f"{LEGEND}.length === 3 && {LEGEND}[2] === '/odom/pose/pose/position/x'")
    area = place_of(page, ".u-over")
    x, y = area["x"] + area["width"] / 2, area["y"] + area["height"] / 2
    page.hover(x, y)
    page.wait_for("/^-15[.]\\d+ s/.test(document.querySelector('[data-test=cursor]').textContent)")
    page.drag([(x, y), (x + 20, y + 20), (x + 0.4 * area["width"], y + 0.3 * area["height"])])
    page.wait_for("document.querySelector('[data-test=hold]').classList.contains('active')")
    page.hover(x, y)
    page.wait_for("/^-9[.]\\d+ s/.test(document.querySelector('[data-test=cursor]').textContent)")
    page.wheel(x, y, -100)
    page.click_on("[data-test=hold]")
    page.wait_for("!document.querySelector('[data-test=hold]').classList.contains('active')")

    page.evaluate(
        "(() => { const e = document.querySelector('[aria-label=Axes]'); e.value = 'xy';"
        " e.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    page.wait_for(f"{LEGEND}.length === 2 && {LEGEND}[1].endsWith('over /odom/twist/twist/linear/x')")


def test_a_page_on_which_nothing_happens_draws_nothing(browser, source):
    with serve(source) as server:
        show(browser, f"{server.url}?panel=scene")
        browser.wait_for("daidalos.state().drawn > 0")
        still = "new Promise((done) => setTimeout(() => done(daidalos.state().drawn), 500))"
        browser.wait_for(f"(async () => daidalos.state().drawn === await {still})()")
        before = browser.evaluate("daidalos.state().drawn")
        assert browser.evaluate(still) == before
        browser.wheel(800, 400, 100)
        browser.wait_for(f"daidalos.state().drawn > {before}")
    assert [error for error in browser.errors if "WebSocket" not in error] == []


def test_a_file_of_rviz_says_what_is_shown(browser, source, robot):
    way = Display("Path", "Way", False, {"topic": "/plan"})
    scan = Display("LaserScan", "Scan", True, {"topic": "/scan", "color": "#00ff00"})
    view = View("top", (1.0, 2.0, 0.0), 20.0, 0.0, 1.57)
    asked = Arrangement(fixed_frame="odom", displays=(scan, way), view=view)
    with serve(source, arrangement=asked) as server:
        show(browser, f"{server.url}?panel=scene&layout=robot.rviz")
        browser.wait_for("daidalos.state().scanPoints > 700", 60)
        state = browser.evaluate("daidalos.state()")
        assert state["fixedFrame"] == "odom"
        assert set(state["displays"]) == {"Scan"}, "nothing comes by itself, and what is off is off"
        names = browser.evaluate("[...document.querySelectorAll('[data-panel=displays] section')].length")
        assert names == 2
        assert browser.evaluate("document.querySelector('[data-test=top-down]').ariaPressed") == "true"
    assert [error for error in browser.errors if "WebSocket" not in error] == []


def test_a_file_of_plotjuggler_says_what_is_plotted(browser, source, robot):
    speed = Plot((Curve("/odom/twist/twist/linear/x", "#ff0000"), Curve("/odom/twist/twist/angular/z")))
    way = Plot((Curve("/odom/pose/pose/position/y", "", "/odom/pose/pose/position/x"),))
    asked = Arrangement(tabs=(("drive", Split(False, (0.3, 0.7), (speed, way))), ("more", speed)), span=10)
    with serve(source, arrangement=asked) as server:
        show(browser, f"{server.url}?panel=plot&layout=plots.xml")
        heights = "[...document.querySelectorAll('[data-panel=plot]')].map((e) => e.getBoundingClientRect().height)"
        upper, lower = browser.wait_for(f"{LEGEND}.length === 3 && {heights}.filter((height) => height > 0)")
        assert upper / (upper + lower) == pytest.approx(0.3, abs=0.06)
        assert browser.evaluate(LEGEND) == [
            "/odom/twist/twist/linear/x",
            "/odom/twist/twist/angular/z",
            "/odom/pose/pose/position/yover /odom/pose/pose/position/x",
        ]
        assert browser.evaluate("document.querySelector('.swatch').value") == "#ff0000"
        browser.wait_for("[...document.querySelectorAll('.legend .figures')].every((e) => e.textContent !== '–')")
    assert [error for error in browser.errors if "WebSocket" not in error] == []


def test_topics_messages_and_plots_are_alive(page):
    page.wait_for("/Hz/.test(document.querySelector('[data-topic=\"/odom\"]').textContent)")
    page.wait_for("document.querySelectorAll('.u-over').length > 0")
    page.wait_for("[...document.querySelectorAll('.legend .figures')].every((e) => e.textContent)")
    page.click_on("[data-topic='/scan'] button.grow")
    page.wait_for("/angle_increment/.test(document.querySelector('[data-test=message]').textContent)")
    assert "820 items" in page.evaluate("document.querySelector('[data-test=message]').textContent")


def test_a_display_can_be_switched_off_and_stays_off(page):
    page.click_on("input[aria-label='Show Laser scan']")
    page.wait_for("daidalos.state().scanPoints === 0")
    page.reload()
    page.wait_for(f"{READY} && daidalos.state().maps.Map?.[0] === 160", 60)
    assert page.evaluate("daidalos.state().scanPoints") == 0
    page.click_on("input[aria-label='Show Laser scan']")
    page.wait_for("daidalos.state().scanPoints > 700")


def test_theme_and_layout_are_remembered_and_the_layout_can_be_reset(page):
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    page.click_on("[data-test=theme]")
    page.wait_for("document.documentElement.dataset.theme === 'light'")
    page.evaluate("document.querySelector('.dv-tab .dv-default-tab-action').click()")
    page.wait_for("localStorage.getItem('daidalos.layout')")
    before = page.evaluate("document.querySelectorAll('.dv-tab').length")
    page.reload()
    page.wait_for(READY, 60)
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
    assert page.wait_for("document.querySelectorAll('.dv-tab').length") == before
    page.evaluate("[...document.querySelectorAll('button')].find((b) => b.textContent === 'Panels').click()")
    page.wait_for("document.querySelector('.menu-item')")
    page.evaluate("[...document.querySelectorAll('.menu-item')].find((b) => b.textContent === 'Reset layout').click()")
    page.wait_for(f"document.querySelectorAll('.dv-tab').length === {before + 1}")
    page.wait_for(SEES, 60)


def test_goes_on_when_time_is_turned_back(page, robot):
    page.wait_for("daidalos.state().time > 12")
    robot.now = 2.0
    page.wait_for("daidalos.state().time < 8 && daidalos.state().time > 2.5")
    page.wait_for(f"{SEES} && daidalos.state().displays.Robot.text === '11 links'")
    assert _distance_from_track(page.evaluate("daidalos.state()"), robot) < 0.05


def test_comes_back_after_the_server_was_away(browser, source, robot):
    with serve(source) as server:
        port = server.port
        show(browser, server.url)
        browser.wait_for(SEES, 60)
    browser.wait_for("document.querySelector('[data-test=connection]').textContent.includes('Reconnecting')")
    assert "Connection lost" in browser.evaluate("document.querySelector('[data-test=lost]').textContent")
    with serve(source, port) as server:
        assert server.port == port
        browser.wait_for(READY, 60)
        browser.wait_for("daidalos.state().topics.length > 10 && !document.querySelector('[data-test=lost]')")
        browser.wait_for(f"{SEES} && daidalos.state().displays.Robot.level === 'ok'", 60)


def test_every_kind_of_display_draws(browser, source, tmp_path):
    display_zoo.fill(source, tmp_path)
    with StudioServer(source, port=0, assets=AssetResolver(lambda _: tmp_path)) as server:
        show(browser, server.url)
        browser.wait_for("document.querySelector('[data-topic=\"/amcl_pose\"] button.icon-button')")
        for topic in ("/amcl_pose", "/point", "/polygon"):
            browser.click_on(f"[data-topic='{topic}'] button.icon-button")
        browser.click_on("input[aria-label='Show Odometry']")
        texts = {
            "Map": "80 × 80 cells of 0.1 m",
            "Robot": "1 links",
            "TF": "2 frames",
            "Goal": "in map",
            "Odometry": "in map",
            "amcl_pose": "in map",
            "cloud": "4000 points in map",
            "marker": "1 markers",
            "markers": "12 markers",
            "particles": "300 poses",
            "path": "60 poses, 4.68 m",
            "point": "in map",
            "polygon": "6 corners",
        }
        for name, text in texts.items():
            browser.wait_for(f"daidalos.state().displays[{name!r}]?.text === {text!r}")
        assert browser.errors == []


@pytest.mark.parametrize(
    ("description", "error"),
    [
        ("<robot name='r'><link name='a'></robot>", "not well-formed"),
        ("<sdf/>", "expected <robot>, found <sdf>"),
        (
            "<robot name='r'><link name='a'><visual><geometry><mesh filename='package://no/a.stl'/>"
            "</geometry></visual></link></robot>",
            "package://no/a.stl: no such file",
        ),
    ],
)
def test_a_bad_robot_description_is_told_at_its_display(browser, source, tmp_path, description, error):
    name = "std_msgs/msg/String"
    source.add_topic("/robot_description", name, latched=True)
    source.send("/robot_description", encode(name, make(name, data=description)))
    with StudioServer(source, port=0, assets=AssetResolver(lambda _: tmp_path)) as server:
        show(browser, server.url)
        browser.wait_for("daidalos.state().displays.Robot.level === 'error'")
        assert error in browser.evaluate("daidalos.state().displays.Robot.text")


def test_a_small_window_still_shows_the_view_and_the_displays(browser, source, robot):
    browser.resize(1024, 700)
    try:
        with serve(source) as server:
            show(browser, server.url)
            browser.wait_for(SEES, 60)
            width = browser.evaluate("document.querySelector('.scene-canvas').clientWidth")
            assert width > 600
            assert browser.evaluate("document.documentElement.scrollWidth") == 1024
    finally:
        browser.resize(1280, 800)


def test_a_phones_window_shows_the_view_whole_and_the_bar_in_order(browser, source, robot):
    browser.resize(390, 760)
    try:
        with serve(source) as server:
            show(browser, server.url)
            browser.wait_for(SEES, 60)
            assert browser.evaluate("document.querySelector('.scene-canvas').clientWidth") > 350
            browser.wait_for("!!document.querySelector('.top-bar .clock')")
            edges = browser.evaluate(
                "[...document.querySelector('.top-bar').children]"
                ".flatMap((each) => [each.getBoundingClientRect().left, each.getBoundingClientRect().right])"
            )
            assert edges == sorted(edges), "nothing lies over its neighbour"
            assert edges[-1] <= 390
            assert browser.evaluate(
                "[...document.querySelectorAll('.top-bar > *')]"
                ".every((each) => each.scrollWidth <= each.clientWidth + 1)"
            )
    finally:
        browser.resize(1280, 800)


class Listener(foxglove.websocket.ServerListener):
    """Notes what the page does at Foxglove's server."""

    def __init__(self) -> None:
        self.published: queue.Queue[bytes] = queue.Queue()

    def on_message_data(self, client, client_channel_id, data):
        self.published.put(bytes(data))


def test_speaks_with_foxgloves_server(browser, source):
    """The page is a client like any other: `?connect=` takes it to a server that is not ours."""
    listener = Listener()
    context = foxglove.Context()
    theirs = foxglove.start_server(
        name="theirs",
        host="127.0.0.1",
        port=0,
        context=context,
        server_listener=listener,
        capabilities=[foxglove.websocket.Capability.ClientPublish],
        supported_encodings=["cdr"],
    )
    name = "geometry_msgs/msg/PointStamped"
    definition = foxglove.Schema(name=name, encoding="ros2msg", data=schema(name).encode())
    channel = foxglove.Channel("/clicked_point", schema=definition, message_encoding="cdr", context=context)
    header = make("std_msgs/msg/Header", stamp=make("builtin_interfaces/msg/Time", sec=1, nanosec=0), frame_id="map")
    point = make("geometry_msgs/msg/Point", x=1.0, y=2.0, z=3.0)
    payload = encode(name, make(name, header=header, point=point))
    try:
        with serve(source) as ours:
            show(browser, f"{ours.url}?connect=ws://127.0.0.1:{theirs.port}")
            browser.wait_for("daidalos.state().serverName === 'theirs'")
            browser.wait_for("daidalos.state().topics.includes('/clicked_point')")
            browser.click_on("[data-topic='/clicked_point'] button.grow")
            # The list of topics subscribes as well, to measure: say it until the message panel listens.
            until = time.monotonic() + 30
            text = ""
            while "x1y2z3" not in text and time.monotonic() < until:
                channel.log(payload)
                text = browser.evaluate("document.querySelector('[data-test=message]')?.textContent ?? ''")
            assert "x1y2z3" in text
            browser.press("u")
            browser.click(*at(browser, 0.3, 0.2))
            data = listener.published.get(timeout=30)
    finally:
        theirs.stop()
    assert decode(name, data).point.x == pytest.approx(0.3, abs=0.02)


ADDED = "[...document.querySelectorAll('[data-display]')].map((e) => e.dataset.display)"
TABS = "[...document.querySelectorAll('.dv-tab')].map((e) => e.textContent)"


def test_a_display_is_added_by_its_topic_and_the_focus_is_given_back(page):
    page.click_on("[data-test=add-display]")
    page.wait_for("document.querySelector('dialog[open]')?.contains(document.activeElement)")
    page.click_on("[data-tab=topic]")
    page.wait_for("document.querySelector('[data-add=\"/camera/image_raw Camera\"]') !== null")
    page.press("ArrowLeft")
    page.wait_for("document.querySelector('[data-tab=type]').ariaSelected === 'true'")
    page.press("ArrowRight")
    page.click_on("[data-add='/camera/image_raw Image']")
    page.wait_for(f"{ADDED}.includes('camera/image_raw') && {TABS}.includes('camera/image_raw')")
    page.wait_for("document.querySelector('[data-panel=image] canvas').width === 160")
    assert page.evaluate("document.activeElement.dataset.test") == "add-display"
    page.click_on("input[aria-label='Show camera/image_raw']")
    page.wait_for(f"!{TABS}.includes('camera/image_raw')")


def test_a_camera_display_draws_the_scene_over_its_pictures(page):
    page.click_on("[data-test=add-display]")
    page.click_on("[data-tab=topic]")
    page.click_on("[data-add='/camera/image_raw Camera']")
    page.wait_for("document.querySelector('[data-test=overlay]')?.width === 160")
    drawn = """(() => {
        const canvas = document.querySelector('[data-test=overlay]');
        const copy = document.createElement('canvas');
        [copy.width, copy.height] = [canvas.width, canvas.height];
        const pen = copy.getContext('2d');
        pen.drawImage(canvas, 0, 0);
        return pen.getImageData(0, 0, copy.width, copy.height).data.filter((_, i) => i % 4 === 3).some((a) => a > 0);
    })()"""
    page.wait_for(drawn)


def test_what_is_shown_is_saved_and_opened_as_a_configuration_of_rviz(browser, source, robot, tmp_path):
    file = tmp_path / "mine.rviz"
    file.write_text(ROS_2)
    with serve(source) as server:
        show(browser, server.url)
        browser.choose_file("[data-test=layout-file]", file)
        browser.wait_for(
            f"location.search.includes('layout=mine.rviz') && {READY} && {ADDED}.includes('Particles')", 60
        )
        browser.wait_for("document.querySelector('[data-display=Particles] [title]').title.includes('not supported')")
        browser.wait_for("daidalos.state().settled")
        browser.click_on("input[aria-label='Show LaserScan']")
        browser.wait_for("!document.querySelector('input[aria-label=\"Show LaserScan\"]').checked")
        browser.evaluate("URL.createObjectURL = (blob) => { window.saved = blob.text(); return 'data:,'; }")
        browser.click_on("[data-test=file]")
        browser.evaluate(
            "[...document.querySelectorAll('.menu-item')].find((e) => e.textContent.includes('.rviz') &&"
            " e.textContent.includes('Save')).click()"
        )
        saved = browser.wait_for("window.saved")
    before, after = parse_rviz(ROS_2, "a"), parse_rviz(saved, "b")
    changed = {a.name for a, b in zip(before.displays, after.displays, strict=True) if a != b}
    assert changed == {"LaserScan"}
    assert (after.view, after.fixed_frame) == (before.view, before.fixed_frame)


def test_plots_are_saved_as_a_layout_of_plotjuggler(browser, source, robot, tmp_path):
    file = tmp_path / "mine.xml"
    file.write_text(LAYOUT)
    with serve(source) as server:
        show(browser, server.url)
        browser.choose_file("[data-test=layout-file]", file)
        browser.wait_for(
            "location.search.includes('layout=mine.xml') && document.querySelectorAll('.panel .plot').length === 3", 60
        )
        browser.evaluate("URL.createObjectURL = (blob) => { window.saved = blob.text(); return 'data:,'; }")
        browser.click_on("[data-test=file]")
        browser.evaluate(
            "[...document.querySelectorAll('.menu-item')]"
            ".find((e) => e.textContent.includes('PlotJuggler .xml')).click()"
        )
        saved = browser.wait_for("window.saved")
    before, after = (parse_plotjuggler(text.encode(), "a") for text in (LAYOUT, saved))
    assert after.left_out == before.left_out, "transforms and custom series are kept"
    ((title, split),) = after.tabs
    ((name, whole),) = before.tabs
    assert (title, split.parts[0], split.parts[1].parts) == (name, whole.parts[0], whole.parts[1].parts)
    assert split.shares == pytest.approx(whole.shares, abs=0.02)


def test_a_layout_is_saved_and_opened(browser, source, robot, tmp_path):
    with serve(source) as server:
        show(browser, server.url)
        browser.wait_for(SEES, 60)
        browser.click_on("input[aria-label='Show Laser scan']")
        browser.evaluate("URL.createObjectURL = (blob) => { window.saved = blob.text(); return 'data:,'; }")
        browser.click_on("[data-test=file]")
        cut = "[...document.querySelectorAll('.menu-item *')].filter((e) => e.scrollWidth > e.clientWidth)"
        assert browser.evaluate(f"{cut}.map((e) => e.textContent)") == []
        browser.evaluate(
            "[...document.querySelectorAll('.menu-item')].find((e) => e.textContent.includes('Save layout')).click()"
        )
        file = tmp_path / "mine.json"
        file.write_text(browser.wait_for("window.saved"))
        show(browser, server.url)
        browser.wait_for(SEES, 60)
        assert browser.evaluate("document.querySelector(\"input[aria-label='Show Laser scan']\").checked")
        browser.choose_file("[data-test=layout-file]", file)
        off = "document.querySelector(\"input[aria-label='Show Laser scan']\")?.checked === false"
        browser.wait_for(f"{READY} && {off}", 60)
        broken = tmp_path / "broken.rviz"
        broken.write_text("Panels: []")
        browser.choose_file("[data-test=layout-file]", broken)
        browser.wait_for("document.querySelector('.pill.status')?.textContent.includes('broken.rviz: not a display')")


def test_labels_of_frames_do_not_lie_over_each_other(page):
    page.click_on("[data-display=TF] button.grow")
    page.click_on("[data-display=TF] input[aria-label=Names]")
    boxes = page.wait_for("daidalos.labels().length > 8 && daidalos.labels()")
    overlaps = [
        (a["text"], b["text"])
        for i, a in enumerate(boxes)
        for b in boxes[i + 1 :]
        if a["left"] < b["right"] and b["left"] < a["right"] and a["top"] < b["bottom"] and b["top"] < a["bottom"]
    ]
    assert overlaps == []


def test_nothing_but_its_x_closes_a_panel(page):
    for _ in range(2):
        for title in ("Message", "Topics", "Log", "Plot"):
            place = page.evaluate(
                f"(() => {{ const tabs = [...document.querySelectorAll('.dv-tab')], title = '{title}';"
                " const b = tabs.find((e) => e.textContent === title).getBoundingClientRect();"
                " return [b.x, b.width, b.y + b.height / 2]; })()"
            )
            left, width, y = place
            for share in (0.2, 0.4, 0.5):
                page.click(left + share * width, y)
            page.wait_for(f"document.querySelectorAll('.dv-tab').length === 6 && {TABS}.includes('{title}')")
