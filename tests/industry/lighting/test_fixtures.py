"""Fixture files in YAML and of the Open Fixture Library: what they say, what they mean, what is wrong with them."""

import json
import math

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.errors import UserError
from daidalos.industry.lighting.fixture import COLOR, FixtureError
from daidalos.industry.lighting.fixture_file import BUILT_IN, fixture_from_yaml, read_fixture
from daidalos.industry.lighting.kinematics import Angles
from daidalos.industry.lighting.look import Look, appearance, read_angles, write_angles, write_look
from daidalos.industry.lighting.open_fixture_library import fixture_from_json

ZEMA = read_fixture("zema_13_channel")
SPOT = {
    "name": "Spot",
    "categories": ["Moving Head"],
    "physical": {"lens": {"degreesMinMax": [10, 30]}},
    "wheels": {
        "Color Wheel": {"slots": [{"type": "Open"}, {"type": "Color", "name": "Deep blue", "colors": ["#0000ff"]}]},
        "Gobo Wheel": {"slots": [{"type": "Open"}, {"type": "Gobo", "name": "Dots"}]},
    },
    "availableChannels": {
        "Pan": {
            "fineChannelAliases": ["Pan fine", "Pan finest"],
            "defaultValue": "50%",
            "capability": {"type": "Pan", "angleStart": "0deg", "angleEnd": "540deg"},
        },
        "Tilt": {
            "fineChannelAliases": ["Tilt fine"],
            "dmxValueResolution": "8bit",
            "defaultValue": 128,
            "capability": {"type": "Tilt", "angleStart": "0deg", "angleEnd": "270deg"},
        },
        "Color Wheel": {
            "capabilities": [
                {"dmxRange": [0, 9], "type": "WheelSlot", "slotNumber": 1},
                {"dmxRange": [10, 19], "type": "WheelSlot", "slotNumber": 2},
                {"dmxRange": [20, 29], "type": "WheelSlot", "slotNumber": 2.5},
            ]
        },
        "Gobo Wheel": {
            "capabilities": [
                {"dmxRange": [0, 99], "type": "WheelSlot", "slotNumber": 1},
                {"dmxRange": [100, 255], "type": "WheelSlot", "slotNumber": 2},
            ]
        },
        "Zoom": {"capability": {"type": "Zoom", "angleStart": "30deg", "angleEnd": "10deg"}},
        "Dimmer": {
            "capabilities": [
                {"dmxRange": [0, 127], "type": "Intensity", "brightnessStart": "0%", "brightnessEnd": "20%"},
                {"dmxRange": [128, 255], "type": "Intensity", "brightnessStart": "20%", "brightnessEnd": "bright"},
            ]
        },
        "Shutter": {
            "capabilities": [
                {"dmxRange": [0, 9], "type": "ShutterStrobe", "shutterEffect": "Closed"},
                {
                    "dmxRange": [10, 199], "type": "ShutterStrobe", "shutterEffect": "Strobe",
                    "speedStart": "60bpm", "speedEnd": "20Hz",
                },
                {"dmxRange": [200, 255], "type": "ShutterStrobe", "shutterEffect": "Open"},
            ]
        },
        "Red": {"capability": {"type": "ColorIntensity", "color": "Red"}},
        "Green": {"capability": {"type": "ColorIntensity", "color": "Green"}},
        "Blue": {"capability": {"type": "ColorIntensity", "color": "Blue"}},
        "Cyan": {"capability": {"type": "ColorIntensity", "color": "Cyan"}},
        "Magenta": {"capability": {"type": "ColorIntensity", "color": "Magenta"}},
        "Yellow": {"capability": {"type": "ColorIntensity", "color": "Yellow"}},
    },
    "modes": [
        {"name": "Wheel", "shortName": "w",
         "channels": ["Pan", "Tilt", "Pan fine", "Tilt fine", "Dimmer", "Shutter", "Color Wheel", "Gobo Wheel",
                      "Zoom"]},
        {"name": "RGB", "channels": ["Pan", "Tilt", "Red", "Green", "Blue"]},
        {"name": "CMY", "channels": ["Pan", "Tilt", "Dimmer", "Cyan", "Magenta", "Yellow"]},
    ],
}  # fmt: skip


def spot(mode=""):
    return fixture_from_json(SPOT, mode, "spot.json")


def test_the_table_of_the_workshop():
    assert ZEMA.size == 13
    colors = [one for _, one in ZEMA.ranges([COLOR])]
    assert [(one.first, one.last) for one in colors] == [(5 * n, 5 * n + 4) for n in range(19)]
    data = bytearray(ZEMA.defaults)
    write_look(ZEMA, Look(0.5, "Magenta"), data)
    assert data[5] in (127, 128)
    assert 250 <= data[6] <= 255
    assert 90 <= data[7] <= 94
    write_look(ZEMA, Look(0.0, "red"), data)
    assert data[5] == 0
    assert 0 <= data[6] <= 9
    write_look(ZEMA, Look(1.0, (1.0, 0.1, 0.1), strobe=20.0), data)
    assert data[6] == 127
    assert 10 <= data[7] <= 14  # red is the nearest whole colour


@given(st.floats(-4.71, 4.71), st.floats(-2.35, 2.35))
def test_sixteen_bits_of_pan_and_tilt(pan, tilt):
    data = bytearray(ZEMA.size)
    write_angles(ZEMA, Angles(pan, tilt), data)
    found = read_angles(ZEMA, data)
    assert abs(found.pan - pan) <= math.radians(540 / 65535) / 2 + 1e-12
    assert abs(found.tilt - tilt) <= math.radians(270 / 65535) / 2 + 1e-12
    coarse = data[0] * 256 + data[1]
    assert coarse == round((pan + math.radians(270)) / math.radians(540) * 65535)


def test_channels_of_a_fixture_of_the_library():
    fixture = spot("w")
    pan, tilt = fixture.channels[0], fixture.channels[1]
    assert (pan.offsets, tilt.offsets) == ((0, 2), (1, 3))  # the third byte of pan is not in this mode
    assert (pan.most, pan.default) == (65535, 32768)
    assert tilt.default == 0x8080
    assert [(one.start, one.end) for one in (*pan.ranges, *tilt.ranges)] == [
        pytest.approx((-math.radians(270), math.radians(270))),
        pytest.approx((-math.radians(135), math.radians(135))),
    ]
    assert fixture.beam_angle == pytest.approx(math.radians(10))


def test_looks_of_a_fixture_of_the_library():
    fixture = spot("w")
    data = bytearray(fixture.defaults)
    write_look(fixture, Look(0.2, "Deep blue", "Dots", math.radians(20), 1.0), data)
    assert data[4] in (127, 128)  # the dimmer's curve has a fifth of the light in the middle
    assert data[5] == 10
    assert 10 <= data[6] <= 19
    assert 100 <= data[7] <= 255
    assert data[8] in (127, 128)
    seen = appearance(fixture, data)
    assert seen.dimmer == pytest.approx(0.2, abs=0.01)
    assert seen.color == (0.0, 0.0, 1.0)
    assert (seen.gobo, seen.strobe) == ("Dots", 1.0)
    assert seen.beam_angle == pytest.approx(math.radians(20), abs=0.01)
    data[6] = 25  # between two slots
    assert appearance(fixture, data).color == (0.5, 0.5, 1.0)


@given(st.sampled_from(["RGB", "CMY"]), st.tuples(*[st.floats(0.0, 1.0)] * 3), st.floats(0.0, 1.0))
def test_mixed_colors_there_and_back(mode, color, dimmer):
    fixture = spot(mode)
    data = bytearray(fixture.defaults)
    write_look(fixture, Look(dimmer, color), data)
    seen = appearance(fixture, data)
    for found, wanted in zip(seen.color, color, strict=True):
        assert seen.dimmer * found == pytest.approx(dimmer * wanted, abs=0.01)


@pytest.mark.parametrize(
    ("look", "words"),
    [
        (Look(2.0), "the dimmer must be from 0 to 1"),
        (Look(color="Cyann"), "did you mean 'Cyan'"),
        (Look(gobo="Stars"), "'Stars' is no gobo"),
        (Look(zoom=0.1), "has no zoom"),
    ],
)
def test_looks_that_a_fixture_cannot_show(look, words):
    data = bytearray(ZEMA.size)
    with pytest.raises(FixtureError, match=words):
        write_look(ZEMA, look, data)


def changed(path, value):
    """Return the built-in fixture with one entry changed."""
    content = yaml.safe_load((BUILT_IN / "zema_13_channel.yaml").read_text())
    *way, last = path
    place = content
    for key in way:
        place = place[key]
    place[last] = value
    return content


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ([], "must be a mapping"),
        (changed(["chanels"], []), "'chanels' is unknown; did you mean 'channels'"),
        (changed(["channels"], []), "'channels' must be a list of 1 to 512"),
        (changed(["channels", 1, "fine"], "Yaw"), "channel 2 is the fine one of 'Yaw', which is not there"),
        (changed(["channels", 0, "default"], 70000), "channel 1: 'default' must be an integer from 0 to 65535"),
        (changed(["channels", 6, "values", 0, "range"], [9, 0]), r"channel 7: values\[0\]: 'range' must be"),
        (changed(["channels", 6, "values", 0, "range"], [0, 99]), "begins within the one before it"),
        (changed(["channels", 6, "values", 0, "function"], "opn"), "'opn' is no function; did you mean 'open'"),
        (changed(["channels", 0, "values", 0, "from"], math.nan), "'from' must be a number"),
        (changed(["channels", 7, "values", 0, "colors"], ["white"]), "'white' is no colour"),
        (changed(["pan_speed_deg"], 0), "'pan_speed_deg' must be a number of at least"),
    ],
)
def test_faults_of_files_in_yaml_are_named(content, words):
    with pytest.raises(FixtureError, match=words):
        fixture_from_yaml(content, "head.yaml")


@pytest.mark.parametrize(
    ("content", "mode", "words"),
    [
        ([], "", "is no fixture of the Open Fixture Library"),
        ({"modes": []}, "", "is no fixture of the Open Fixture Library"),
        (SPOT, "RBG", "'RBG' is no mode; "),
        ({**SPOT, "availableChannels": {"Pan": 1}}, "", "'Pan' must be an object"),
        (
            {"modes": [{"channels": ["A"]}], "availableChannels": {"A": {"capability": {"dmxRange": [4, 300]}}}},
            "",
            "'dmxRange' must ascend within 0 and 255",
        ),
        (
            {
                "modes": [{"channels": ["A"]}],
                "availableChannels": {"A": {"capability": {"type": "Pan", "angle": "90 gon"}}},
            },
            "",
            "'90 gon' has no known unit",
        ),
    ],
)
def test_faults_of_files_of_the_library_are_named(content, mode, words):
    with pytest.raises(FixtureError, match=words):
        fixture_from_json(content, mode, "a.json")


anything = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 300) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=5,
)


@given(st.sampled_from(["name", "physical", "wheels", "availableChannels", "modes"]), anything, st.booleans())
def test_no_file_of_the_library_ends_in_a_traceback(key, value, is_inner):
    content = json.loads(json.dumps(SPOT))
    if is_inner:
        content["availableChannels"]["Color Wheel"] = value
    else:
        content[key] = value
    problem = ""
    try:
        assert fixture_from_json(content, "", "a.json").defaults is not None
    except FixtureError as error:
        problem = str(error)
    assert problem.startswith("a.json: " if problem else "")


def test_files_by_name_and_path(tmp_path):
    (tmp_path / "spot.json").write_text(json.dumps(SPOT))
    assert read_fixture("spot.json", "CMY", tmp_path).size == 6
    (tmp_path / "bad.json").write_text("{")
    with pytest.raises(UserError, match=r"bad\.json:1: "):
        read_fixture("bad.json", "", tmp_path)
    with pytest.raises(UserError, match="is no built-in fixture and no path of a file; did you mean 'zema_13_channel'"):
        read_fixture("zema_13_chanel")
    with pytest.raises(UserError, match="'8-channel' is no mode"):
        read_fixture("zema_13_channel", "8-channel")
