"""The flows of Node-RED: their wires, and what their functions return, run by Node.js."""

import json
import math
import shutil
import subprocess

import pytest

from daidalos.cli.daidalos import main
from daidalos.industry.lighting import artnet, messages
from daidalos.industry.lighting.fixture_file import read_fixture
from daidalos.industry.lighting.look import appearance

RUN = """
const cases = JSON.parse(require('fs').readFileSync(0));
const store = () => { const kept = {}; return { get: k => kept[k], set: (k, v) => { kept[k] = v; } }; };
const flow = store(), global = store(), contexts = {};
for (const [key, value] of Object.entries(cases.global)) { global.set(key, value); }
const results = cases.calls.map(([id, code, msg]) => {
    contexts[id] ??= store();
    const result = new Function('msg', 'context', 'flow', 'global', 'Buffer', code)(
        msg, contexts[id], flow, global, Buffer);
    if (result && Buffer.isBuffer(result.payload)) { result.payload = result.payload.toString('hex'); }
    return result;
});
console.log(JSON.stringify(results));
"""


def flow(name, capsys):
    assert main(["light", "flow", name]) == 0
    return {one["id"]: one for one in json.loads(capsys.readouterr().out)}


def called(nodes, *calls, **variables):
    """Return what functions of a flow return, one after the other."""
    if not shutil.which("node"):
        pytest.skip("there is no node")
    cases = {"global": variables, "calls": [(name, nodes[name]["func"], msg) for name, msg in calls]}
    done = subprocess.run(["node", "-e", RUN], input=json.dumps(cases), capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", ["mqtt", "artnet"])
def test_every_wire_and_reference_has_an_end(name, capsys):
    nodes = flow(name, capsys)
    for one in nodes.values():
        for end in (end for wire in one.get("wires", []) for end in wire):
            assert nodes[end]["z"] == "tab"
        for key in ("group", "page", "theme", "ui", "broker"):
            if key in one and one["type"] != "mqtt-broker":
                assert one[key] in nodes
    places = {(one["x"], one["y"]) for one in nodes.values() if "x" in one}
    assert len(places) == sum("x" in one for one in nodes.values())


def test_the_flow_over_mqtt_sends_what_heads_expect(capsys):
    nodes = flow("mqtt", capsys)
    found = called(
        nodes,
        ("point", {"topic": "x", "payload": 0.5}),
        ("point", {"topic": "z", "payload": 0.8}),
        ("dimmer_channel", {"payload": 200}),
        ("color_channel", {"payload": 18}),
    )
    texts = [json.dumps(one["payload"]).encode() for one in found]
    assert [messages.parse("point", text) for text in texts[:2]] == [(0.5, 0.0, 0.0), (0.5, 0.0, 0.8)]
    assert [messages.parse("dashboard", text) for text in texts[2:]] == [{6: 200}, {8: 92}]
    assert nodes["point_out"]["topic"] == "Moving-head/point"
    assert nodes["dashboard_out"]["topic"] == "Moving-head/dashboard"
    messages.parse("point", nodes["part"]["payload"].encode())


def test_the_flow_by_artnet_sends_packets_of_the_standard(capsys):
    nodes = flow("artnet", capsys)
    found = called(
        nodes,
        ("artdmx", {}),
        ("angles", {"topic": "pan", "payload": 30.9638}),
        ("angles", {"topic": "tilt", "payload": -16.2537}),
        ("level", {"payload": 255}),
        ("artdmx", {}),
        ("artdmx", {}),
        address=10,
        universe=0x123,
    )
    assert found[0] is None  # nothing is sent before something is set
    packets = [artnet.parse_dmx(bytes.fromhex(one["payload"])) for one in found[4:]]
    assert [(one.universe, one.sequence, len(one.data)) for one in packets] == [(0x123, 1, 512), (0x123, 2, 512)]
    seen = appearance(read_fixture("zema_13_channel"), packets[0].data, 9)
    assert math.degrees(seen.angles.pan) == pytest.approx(30.9638, abs=0.005)
    assert math.degrees(seen.angles.tilt) == pytest.approx(-16.2537, abs=0.003)
    assert seen.dimmer == 1.0
    assert bytes.fromhex(found[4]["payload"]) == artnet.dmx_packet(0x123, 1, packets[0].data)
