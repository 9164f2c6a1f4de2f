"""What leaves the machine: frames of heads, their rate, re-sending, blackout, and configuration files."""

import itertools
import math
import socket
import threading

import pytest

from daidalos.common.errors import UserError
from daidalos.industry.lighting import artnet, enttec, sacn
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.fixture import FixtureError
from daidalos.industry.lighting.fixture_file import read_fixture
from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.kinematics import Angles, Geometry, PointingError
from daidalos.industry.lighting.look import Look, read_angles
from daidalos.industry.lighting.outputs import ArtNetOutput, SacnOutput, UsbOutput
from daidalos.industry.lighting.show import FRAME_S, REPEAT_S, Show

ZEMA = read_fixture("zema_13_channel")
GEOMETRY = read_configuration(DEFAULT).make_heads()[0].geometry
PLACE = (0.5, -0.3, 0.8)


def head(name="a", universe=1, address=1, **options):
    return Head(name, ZEMA, GEOMETRY, universe, address, **options)


@pytest.fixture
def receiver():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        one.settimeout(10.0)
        yield one


def test_a_head_begins_dark_and_lights_up_where_it_points():
    one = head(is_smooth=False)
    assert one.levels[5] == 0
    assert one.levels[6] <= 9
    angles = one.point(PLACE)
    assert one.levels[5] == 255
    assert one.levels[6] >= 250
    found = read_angles(ZEMA, one.levels)
    assert found.pan == pytest.approx(angles.pan, abs=1e-4)
    reached = GEOMETRY.point(found, math.dist((0, 0, 2.8), PLACE))
    assert math.dist(reached, PLACE) < 3e-4  # half a step of both axes at 2 m
    one.blackout()
    assert one.levels[5] == 0
    assert read_angles(ZEMA, one.levels) == found


def test_what_is_refused_leaves_the_channels_alone():
    one = head(is_smooth=False)
    one.point(PLACE)
    before = one.levels
    for wrong in (
        lambda: one.point((0.0, 0.0, 9.0)),
        lambda: one.turn(Angles(9.0, 0.0)),
        lambda: one.show(Look(color="Mauve")),
        lambda: one.set_channels({6: 0, 14: 1}),
        lambda: one.set_channels({6: 0, 7: 256}),
    ):
        with pytest.raises((PointingError, FixtureError)):
            wrong()
    assert one.levels == before


def test_channels_by_number_hold_until_the_next_command():
    one = head()
    one.point(PLACE)
    while one.step(FRAME_S):
        pass
    one.set_channels({1: 200, 2: 0, 6: 30})
    assert (one.levels[0], one.levels[5]) == (200, 30)
    assert one.angles.pan == pytest.approx(math.radians(200 * 256 / 65535 * 540 - 270))
    assert not one.is_moving
    one.point(PLACE)
    assert one.levels[5] == 30  # a point moves, and leaves the dimmer


def test_inverted_axes_turn_the_other_way():
    straight, inverted = head(is_smooth=False), head(is_smooth=False, is_pan_inverted=True, is_tilt_inverted=True)
    assert straight.point(PLACE) == inverted.point(PLACE)
    one, other = read_angles(ZEMA, straight.levels), read_angles(ZEMA, inverted.levels)
    assert (one.pan, one.tilt) == pytest.approx((-other.pan, -other.tilt), abs=1e-4)


def test_frames_come_at_the_rate_of_the_standards():
    show = Show([head()])
    one = show.head("a")
    sent = []

    def run(start, end):
        now = start
        while now < end:
            sent.extend((now, data) for _, data in show.frames(now))
            now = max(show.next_due(), now + 1e-4)

    run(0.0, 10.0)
    gaps = [after - before for (before, _), (after, _) in itertools.pairwise(sent)]
    assert gaps[:3] == pytest.approx([REPEAT_S] * 3)  # the same levels three times, as sACN asks
    assert all(0.8 <= gap <= 1.0 for gap in gaps[3:])
    sent.clear()
    one.point(PLACE)
    show.mark(one)
    run(10.0, 11.5)
    gaps = [after - before for (before, _), (after, _) in itertools.pairwise(sent)]
    assert min(gaps) >= FRAME_S - 1e-9
    positions = [int.from_bytes(data[:2], "big") for _, data in sent]
    assert positions == sorted(positions)  # it moves one way and stands
    assert len(set(positions)) > 5
    steps = [after - before for before, after in itertools.pairwise(positions)]
    assert max(steps) <= ZEMA.pan_speed * FRAME_S / math.radians(540) * 65535 + 1


@pytest.mark.parametrize("is_smooth", [False, True])
def test_no_second_has_more_frames_than_a_dmx_line_carries(is_smooth):
    show = Show([head(is_smooth=is_smooth)])
    one, now, sent = show.head("a"), 0.0, []
    for turn in range(40):
        one.point((0.5, (-1.0) ** turn, 0.8))
        show.mark(one)
        end = now + 0.013 * turn
        while now <= end:
            sent += [now for _ in show.frames(now)]
            now = max(show.next_due(), now + 1e-4)
        now = end
    assert max(sum(start <= time < start + 1.0 for time in sent) for start in sent) <= 45


def test_heads_that_overlap_are_named():
    with pytest.raises(UserError, match=r"'a' \(channels 1 to 13\) and 'b' \(13 to 25\) overlap in universe 1"):
        Show([head("a"), head("b", address=13)])
    with pytest.raises(UserError, match="two heads are named 'a'"):
        Show([head("a"), head("a", address=14)])
    with pytest.raises(UserError, match="there is no head 'heda'; did you mean 'head'"):
        Show([head("head")]).head("heda")
    with pytest.raises(FixtureError, match="channels 501 to 513 are not within 1 to 512"):
        head(address=501)
    with pytest.raises(FixtureError, match="has no pan"):
        Head("x", read_fixture_without_pan(), Geometry())


def read_fixture_without_pan():
    from dataclasses import replace

    return replace(ZEMA, channels=ZEMA.channels[1:])


def packets(receiver, parse, until):
    """Receive until a packet fulfils a condition; return all."""
    found = []
    while not found or not until(found[-1]):
        found.append(parse(receiver.recv(2048)))
    return found


def test_artnet_of_two_universes_ends_with_a_blackout(receiver):
    show = Show([head("a"), head("b", universe=0x123, address=20)])
    with Engine(show, [ArtNetOutput(port=receiver.getsockname()[1])]) as engine:
        engine.command("b", lambda one: one.point(PLACE))
        found = packets(receiver, artnet.parse_dmx, lambda one: one.universe == 0x123 and one.data[24] == 255)
    found += packets(receiver, artnet.parse_dmx, lambda one: one.universe == 0x123 and one.data[24] == 0)
    assert {one.universe for one in found} == {1, 0x123}
    sequences = [one.sequence for one in found if one.universe == 0x123]
    assert sequences == list(range(1, len(sequences) + 1))


def test_sacn_ends_with_a_blackout_and_says_so(receiver):
    with Engine(Show([head()]), [SacnOutput(port=receiver.getsockname()[1])]) as engine:
        engine.command("a", lambda one: one.point(PLACE))
        parse = _sacn_or_none
        found = [one for one in packets(receiver, parse, lambda one: one is not None and one.data[5] == 255) if one]
    found += [one for one in packets(receiver, parse, lambda one: one is not None and one.is_terminated) if one]
    assert [one.sequence for one in found] == list(range(len(found)))
    assert found[-2].data[5] == 0
    assert len({one.cid for one in found}) == 1


def _sacn_or_none(packet):
    return None if packet[18:22] == b"\0\0\0\x08" else sacn.parse_data(packet)


def test_a_poll_is_answered_once_for_each_universe(receiver):
    output = ArtNetOutput(port=receiver.getsockname()[1], reply_port=0)
    assert output.answers_polls
    receiver.sendto(artnet.poll_packet(), ("127.0.0.1", output._replier.getsockname()[1]))
    receiver.sendto(b"Art-Net\0rubbish", ("127.0.0.1", output._replier.getsockname()[1]))
    output.maintain(0.0, [1, 2])
    output.maintain(1.0, [1, 2])  # at most a second later
    replies = [receiver.recv(2048) for _ in range(2)]
    assert [reply[186] for reply in replies] == [1, 2]
    assert {artnet.operation(reply) for reply in replies} == {artnet.OP_POLL_REPLY}
    output.close()


class Widget:
    """Serial port that keeps what is written, and can be pulled out."""

    def __init__(self):
        self.written, self.is_out = b"", False

    def write(self, data):
        if self.is_out:
            raise OSError("device disconnected")
        self.written += data

    def close(self):
        pass


def test_a_usb_widget_that_is_pulled_out_and_put_in_again():
    widgets, lines, has_failed, works = [], [], threading.Event(), threading.Event()

    def open_port(device):
        widgets.append(Widget())
        return widgets[-1]

    def report(line):
        lines.append(line)
        (has_failed if "cannot send" in line else works).set()

    with Engine(Show([head()]), [UsbOutput("/dev/x", 1, open_port)], report) as engine:
        engine.command("a", lambda one: widgets[0].__setattr__("is_out", True))
        assert has_failed.wait(10.0)
        engine.command("a", lambda one: one.point(PLACE))
        assert works.wait(10.0)
    assert lines == ["cannot send: device disconnected", "the output works again"]
    frames = [enttec.parse_frame(b"\x7e" + part + b"\xe7") for part in widgets[-1].written[1:-1].split(b"\xe7\x7e")]
    assert frames[-1][1][6] == 0  # the blackout, after the start code


def open_all(path):
    configuration = read_configuration(path)
    configuration.make_heads()
    configuration.make_outputs()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[]", "must be a mapping with the lists 'heads' and 'outputs'"),
        ("head: []", "'head' is unknown; did you mean 'heads'"),
        ("heads: []", "'heads' is empty"),
        ("heads: [{nam: a}]", r"'heads\[0\]': parameter 'nam'"),
        ("heads: [{position: [1, 2]}]", "'position' must have 3 elements"),
        ("heads: [{universe: 70000}]", "'universe' must be at most 63999"),
        ("heads: [{fixture: zema_13_chanel}]", "did you mean 'zema_13_channel'"),
        ("heads: [{color: '#12'}]", "'#12' is no colour"),
        ("heads: [{}]\noutputs: [{protocol: artnt}]", "'artnt' is no protocol; did you mean 'artnet'"),
        ("heads: [{}]\noutputs: [{protocol: sacn, priority: 300}]", "'priority' must be at most 200"),
        ("heads: [{universe: 0}]\noutputs: [{protocol: sacn}]", "universe 0 does not exist in sacn"),
        ("heads: [{}]\noutputs: [{protocol: enttec, device: /dev/none}]", "cannot open the USB widget at /dev/none"),
        ("heads: [{}]\noutputs: [{protocol: artnet, host: no host}]", "there is no host 'no host'"),
    ],
)
def test_faults_of_a_configuration_are_named(tmp_path, text, words):
    path = tmp_path / "lights.yaml"
    path.write_text(text)
    with pytest.raises((UserError, OSError), match=words):
        open_all(path)
