"""Work sequences: what files say, how runs go on, and devices and confirmations over MQTT."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

import pytest

from daidalos.common.errors import UserError
from daidalos.common.pose3 import Vector
from daidalos.industry.assistance.broker import AssistBroker
from daidalos.industry.assistance.device import Content, Device, DeviceError
from daidalos.industry.assistance.runner import Runner, write_times
from daidalos.industry.assistance.sequence import (
    AFTER,
    BUTTON,
    HAND,
    MQTT,
    TOPIC,
    Confirmation,
    Sequence,
    Step,
    read_sequence,
)
from daidalos.industry.lighting.device import MqttParameters
from mqtt_brokers import free_port

FILE = """
name: Gearbox
devices:
  lamp: {kind: moving_head}
  tower: {kind: light_tower, universe: 3}
steps:
  - name: Take the flange
    show: {lamp: {point: [-0.5, 0.4, 0.83], color: red}, tower: {color: yellow}}
  - name: Press it in
    show: {lamp: [0.6, 0.35, 0.9]}
    confirm: {mqtt: press/done, payload: ok}
  - name: Check it
    confirm: {topic: /checked, type: std_msgs/msg/Bool}
  - name: Done
    confirm: {after: 1.5}
"""


def read(tmp_path: Path, text: str) -> Sequence:
    file = tmp_path / "gearbox.yaml"
    file.write_text(text)
    return read_sequence(file)


def test_a_file(tmp_path: Path) -> None:
    found = read(tmp_path, FILE)
    assert found.name == "Gearbox"
    assert {name: one.kind for name, one in found.devices.items()} == {"lamp": "moving_head", "tower": "light_tower"}
    first = found.steps[0].showings
    assert (first[0].place, first[0].content) == ((-0.5, 0.4, 0.83), Content("red"))
    assert (first[1].place, first[1].content) == (None, Content("yellow"))
    assert found.steps[1].showings[0].place == (0.6, 0.35, 0.9)
    assert [step.confirmation for step in found.steps] == [
        Confirmation(BUTTON),
        Confirmation(MQTT, "press/done", "ok"),
        Confirmation(TOPIC, "/checked", type_name="std_msgs/msg/Bool"),
        Confirmation(AFTER, seconds=1.5),
    ]
    assert found.mqtt == MqttParameters()


@pytest.mark.parametrize(
    ("before", "after", "problem"),
    [
        (
            "kind: moving_head",
            "kind: moving_haed",
            "there is no assistance device 'moving_haed'; did you mean 'moving_head'",
        ),
        ("lamp: [0.6", "lapm: [0.6", "there is no device 'lapm'; did you mean 'lamp'"),
        ("[-0.5, 0.4, 0.83]", "[-0.5, 0.4]", r"steps\[0\].*'lamp': 'point' must be \[x, y, z\]"),
        ("[-0.5, 0.4, 0.83]", "[-0.5, 0.4, .nan]", "finite"),
        ("{color: yellow}", "{point: [0, 0, 0]}", "cannot point"),
        ("{color: yellow}", "{colour: yellow}", "'colour' is unknown; did you mean 'color'"),
        ("{after: 1.5}", "{after: -1}", "must be a time in seconds"),
        ("{after: 1.5}", "{after: 1, mqtt: a}", "one of mqtt, topic, after and hand"),
        ("universe: 3", "universe: -3", "universe.*at least 0"),
        ("name: Done", "title: Done", "'title' is unknown"),
        ("steps:", "stepz:", "'stepz' is unknown; did you mean 'steps'"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, before: str, after: str, problem: str) -> None:
    with pytest.raises(UserError, match=f"gearbox.yaml.*{problem}"):
        read(tmp_path, FILE.replace(before, after))


class Recorded(Device):
    """Device that notes what it shows."""

    def __init__(self) -> None:
        self.shown: list[Any] = []
        self.changed = threading.Condition()

    def point(self, place: Vector, content: Content) -> None:
        if place[2] > 5.0:
            raise DeviceError("out of reach")
        self._note((place, content.color))

    def show(self, content: Content) -> None:
        self._note(content.color)

    def clear(self) -> None:
        self._note(None)

    def _note(self, what: Any) -> None:
        with self.changed:
            self.shown.append(what)
            self.changed.notify_all()


class Workplace:
    """A run with recorded devices, whose clock the test sets, and whose worker acts when a step is announced."""

    def __init__(self, sequence: Sequence, acts: dict[int, list[Confirmation]]) -> None:
        self.now, self.lines, self.acts = 0.0, list[str](), acts
        self.devices = {name: Recorded() for name in sequence.devices}
        self.runner = Runner(sequence, self.devices, self.clock, self.announce, self.lines.append)

    def clock(self) -> float:
        self.now += 0.5
        return self.now

    def announce(self, number: int, step: Step | None) -> None:
        for event in self.acts.get(number, []):
            if event.kind == "q":
                self.runner.abort()
            else:
                self.runner.confirm(event)


def test_a_run(tmp_path: Path) -> None:
    sequence = read(tmp_path, FILE)
    place = Workplace(
        sequence,
        {
            1: [Confirmation(), Confirmation()],  # the second press does not confirm the next step
            2: [Confirmation(), Confirmation(MQTT, "press/done", "no"), Confirmation(MQTT, "press/done", "ok")],
            3: [Confirmation(TOPIC, "/other"), Confirmation(TOPIC, "/checked")],
        },
    )
    times = place.runner.run()
    assert [(one.number, one.name, one.confirmed_by) for one in times] == [
        (1, "Take the flange", "button"),
        (2, "Press it in", "mqtt press/done"),
        (3, "Check it", "topic /checked"),
        (4, "Done", "after"),
    ]
    assert [one.began for one in times] == sorted(one.began for one in times)
    assert times[3].seconds >= 1.5
    assert place.devices["lamp"].shown == [((-0.5, 0.4, 0.83), "red"), ((0.6, 0.35, 0.9), ""), None, None, None]
    assert place.devices["tower"].shown == ["yellow", None, None, None, None]
    write_times(tmp_path / "times.csv", times)
    assert (tmp_path / "times.csv").read_text().splitlines()[1].startswith("1,Take the flange,")
    with pytest.raises(FileExistsError):
        write_times(tmp_path / "times.csv", times)


def test_an_aborted_run_and_a_device_that_fails(tmp_path: Path) -> None:
    sequence = read(tmp_path, FILE.replace("0.83", "9"))
    place = Workplace(sequence, {1: [Confirmation()], 2: [Confirmation("q")]})
    assert [one.number for one in place.runner.run()] == [1]
    assert place.lines == ["lamp: out of reach"]
    assert place.devices["lamp"].shown[-1] is None


FOLLOWING = """
devices: {lamp: {kind: moving_head}, tower: {kind: light_tower}}
world_frame: cell
camera: {depth: /eye/depth, hold: 0.2}
steps:
  - {name: Watch the arm, show: {lamp: {follow: /target, color: red}}, confirm: {topic: /done}}
  - {name: Take it, show: {lamp: {follow: /target}}, confirm: {hand: [0.5, 0.25, 1]}}
"""


def test_a_device_follows_the_newest_point(tmp_path: Path) -> None:
    sequence = read(tmp_path, FOLLOWING)
    assert (sequence.world_frame, sequence.camera.depth, sequence.camera.hold) == ("cell", "/eye/depth", 0.2)
    hand = sequence.confirmations(HAND)
    assert [(one.name, one.place) for one in hand] == [("[0.5, 0.25, 1]", (0.5, 0.25, 1.0))]
    place = Workplace(sequence, {2: hand})
    lamp = place.devices["lamp"]
    seen: list[Any] = []

    def work() -> None:
        """Send a flood of points, and confirm the first step when the last of them is shown."""
        for n in range(10_000):
            place.runner.follow("/target", (0.0, 0.0, n / 1e5))
            place.runner.follow("/other", (9.0, 9.0, 9.0))
        with lamp.changed:
            lamp.changed.wait_for(lambda: lamp.shown[-1:] == [((0.0, 0.0, 9999 / 1e5), "red")], 20.0)
            seen.extend(lamp.shown)
        place.runner.confirm(Confirmation(TOPIC, "/done"))

    thread = threading.Thread(target=work)
    thread.start()
    times = place.runner.run()
    thread.join()
    assert [one.confirmed_by for one in times] == ["topic /done", "hand [0.5, 0.25, 1]"]
    assert seen[0] is None or seen[0][1] == "red"  # dark until a point came
    assert lamp.shown[len(seen) :] == [((0.0, 0.0, 9999 / 1e5), ""), None]  # known when the next step begins


@pytest.mark.parametrize(
    ("before", "after", "problem"),
    [
        ("follow: /target, color", "follow: /target, point: [0, 0, 0], color", "either 'point' or 'follow'"),
        ("{lamp: {follow: /target}}", "{tower: {follow: /target}}", "cannot point"),
        ("{lamp: {follow: /target}}", "{lamp: {folow: /target}}", "'folow' is unknown; did you mean 'follow'"),
        ("hand: [0.5, 0.25, 1]", "hand: [0.5, .nan, 1]", "'hand' must be"),
        ("hold: 0.2", "hold: -1", "'hold' must be at least 0"),
        ("hold: 0.2", "hald: 1", "hald"),
        ("world_frame: cell", "world_frame: []", "name of a frame"),
    ],
)
def test_what_cannot_be_followed_or_seen_is_named(tmp_path: Path, before: str, after: str, problem: str) -> None:
    with pytest.raises(UserError, match=f"gearbox.yaml.*{problem}"):
        read(tmp_path, FOLLOWING.replace(before, after))


def test_devices_and_confirmations_over_mqtt() -> None:
    mqtt = pytest.importorskip("paho.mqtt.client")
    pytest.importorskip("amqtt")
    port, device, confirmed = free_port(), Recorded(), list[Confirmation]()
    changed = threading.Condition()
    heard: dict[str, str] = {}

    def hear(client: Any, data: Any, message: Any) -> None:
        with changed:
            heard[message.topic] = message.payload.decode()
            changed.notify_all()

    def expect(topic: str, text: str) -> None:
        with changed:
            assert changed.wait_for(lambda: text in heard.get(topic, ""), 30.0), heard

    def confirm(event: Confirmation) -> None:
        with changed:
            confirmed.append(event)
            changed.notify_all()

    with AssistBroker(MqttParameters(port=port), {"lamp": device}, ["done"], confirm, lambda line: None) as broker:
        client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        client.on_message = hear
        client.connect("127.0.0.1", port)
        client.subscribe("assist/#", 1)
        client.loop_start()
        expect("assist/availability", "online")
        expect("assist/lamp/skills", '["point", "show"]')
        for topic, content, problem in (
            ("point", "[0, 0, 9]", "out of reach"),
            ("point", "[0, 0]", "'point' must be"),
            ("point", '{"color": "red"}', "needs a point"),
            ("show", "[0, 0, 1]", "takes no point"),
            ("point", '{"follow": "/target"}', "'follow' is for steps"),
            ("show", "{", "not valid JSON"),
        ):
            client.publish(f"assist/lamp/{topic}", content, qos=1)
            expect("assist/lamp/error", problem)
        assert device.shown == []
        client.publish("assist/lamp/point", '{"point": [0, 0, 1], "color": "red"}', qos=1)
        with changed:
            assert changed.wait_for(lambda: heard["assist/lamp/error"] == "", 30.0)
        assert device.shown == [((0.0, 0.0, 1.0), "red")]
        client.publish("done", "ok", qos=1)
        with changed:
            assert changed.wait_for(lambda: bool(confirmed), 30.0)
        assert confirmed == [Confirmation(MQTT, "done", "ok")]
        broker.announce(2, 4, Step("Press it in", (), Confirmation()))
        expect("assist/step", json.dumps({"number": 2, "of": 4, "name": "Press it in"}))
        client.disconnect()
        client.loop_stop()
