"""Heads over MQTT: commands, states, errors, lost brokers and floods, on the embedded broker and on Mosquitto."""

import json
import math
import queue
import shutil
import socket
import subprocess
import sys
import threading

import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.errors import UserError
from daidalos.industry.lighting import messages
from daidalos.industry.lighting.configuration import DEFAULT, read_configuration
from daidalos.industry.lighting.device import Address, MqttParameters, parse_url
from daidalos.industry.lighting.embedded_broker import EmbeddedBroker
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.look import Look
from daidalos.industry.lighting.mqtt_service import MqttService
from daidalos.industry.lighting.show import Show
from mqtt_brokers import free_port, mosquitto

mqtt = pytest.importorskip("paho.mqtt.client")
pytest.importorskip("amqtt")

PATIENCE_S = 30.0


class Person:
    """Client that sends commands and waits for what comes back."""

    def __init__(self, port):
        self.port = port
        self._changed = threading.Condition()
        self.messages = []
        self.client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        self.client.on_message = self._keep
        self.client.on_connect = lambda client, *_: client.subscribe(
            [(f"Moving-head/{name}", 1) for name in ("state", "error", "availability")]
        )
        self.client.connect("127.0.0.1", port)
        self.client.loop_start()
        self.wait("availability", lambda text: text == "online")

    def _keep(self, client, data, message):
        with self._changed:
            self.messages.append((message.topic.partition("/")[2], message.payload.decode(), message.retain))
            self._changed.notify_all()

    def send(self, name, content, qos=1):
        text = content if isinstance(content, str) else json.dumps(content)
        self.client.publish(f"Moving-head/{name}", text, qos=qos)

    def wait(self, name, holds, start=0):
        """Return the first message of a property, from the start, that fulfils a condition."""
        found = []

        def is_here():
            found.extend(text for one, text, _ in self.messages[start:] if one == name and holds(text))
            return bool(found)

        with self._changed:
            assert self._changed.wait_for(is_here, PATIENCE_S), self.messages[-5:]
        return found[0]

    def state(self, holds, start=0):
        return json.loads(self.wait("state", lambda text: holds(json.loads(text)), start))

    def error(self, start=0):
        return json.loads(self.wait("error", bool, start))

    def close(self):
        self.client.disconnect()
        self.client.loop_stop()


@pytest.fixture
def engine():
    with Engine(Show(read_configuration(DEFAULT).make_heads()), []) as one:
        yield one


@pytest.fixture(params=["embedded", "mosquitto"])
def person(request, engine, tmp_path):
    """Someone on the broker of a running service."""
    port = free_port()
    if request.param == "embedded":
        with MqttService(engine, ["Moving-head"], MqttParameters(port=port)):
            one = Person(port)
            yield one
            one.close()
        return
    with mosquitto(port, tmp_path), MqttService(
        engine, ["Moving-head"], MqttParameters(broker=f"mqtt://127.0.0.1:{port}")
    ):  # fmt: skip
        one = Person(port)
        yield one
        one.close()


def test_points_channels_and_looks(person, engine):
    person.wait("availability", lambda text: text == "online")
    person.send("point", [0.5, -0.3, 0.8])
    state = person.state(lambda one: one["point"] == [0.5, -0.3, 0.8] and not one["moving"])
    assert (state["pan_deg"], state["tilt_deg"]) == pytest.approx((30.9638, -16.2537), abs=1e-3)
    assert state["lit"]
    person.send("dashboard", {"buckets": [{"channel": 6, "value": 30}, {"channel": 8, "value": 12.0}]}, qos=2)
    assert person.state(lambda one: one["channels"][5] == 30)["channels"][7] == 12
    person.send("look", {"color": "Magenta", "dimmer": 0.5}, qos=0)
    state = person.state(lambda one: one["color"] == "Magenta")
    assert 90 <= state["channels"][7] <= 94
    person.send("blackout", "")
    person.state(lambda one: not one["lit"] and one["channels"][5] == 0)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("point", "[1, 2", "is not valid JSON; expected [x, y, z]"),
        ("point", "[1, 2]", "is no point"),
        ("point", "[NaN, 0, 0]", "finite numbers"),
        ("point", [0, 0, 9], "out of range"),
        ("dashboard", {"bucket": []}, "has no list 'buckets'"),
        ("dashboard", {"buckets": [{"channel": 14, "value": 1}]}, "there is no channel 14"),
        ("dashboard", {"buckets": [{"channel": 6, "value": 256}]}, "must be from 0 to 255"),
        ("look", {"colour": "red"}, "did you mean 'color'"),
        ("look", {"color": "mauve"}, "'mauve' is no color"),
    ],
)
def test_what_is_refused_holds_the_head_still(engine, name, content, words):
    port = free_port()
    with MqttService(engine, ["Moving-head"], MqttParameters(port=port)):
        one = Person(port)
        one.send("point", [0.5, -0.3, 0.8])
        before = one.state(lambda state: state["point"] == [0.5, -0.3, 0.8] and not state["moving"])
        start = len(one.messages)
        one.send(name, content)
        error = one.error(start)
        assert words in error["error"]
        assert error["topic"] == f"Moving-head/{name}"
        assert engine.look_at("Moving-head", lambda head: list(head.levels)) == before["channels"]
        one.send("point", [0.5, -0.3, 0.8])
        one.wait("error", lambda text: text == "", start)
        one.close()


def test_states_are_retained_and_the_end_is_announced(engine):
    port = free_port()
    with EmbeddedBroker("127.0.0.1", port):
        with MqttService(engine, ["Moving-head"], MqttParameters(broker=f"mqtt://127.0.0.1:{port}")):
            first = Person(port)
            first.send("point", [1, 1, 0])
            first.state(lambda one: one["point"] == [1, 1, 0] and not one["moving"])
            late = Person(port)
            late.state(lambda one: one["point"] == [1, 1, 0])
            assert next(retained for name, _, retained in late.messages if name == "state")
        late.wait("availability", lambda text: text == "offline")
        first.close()
        late.close()


def test_a_lost_broker_darkens_the_head_until_it_is_back(engine):
    port = free_port()
    went_dark, lit_again = threading.Event(), threading.Event()
    head = engine.look_at("Moving-head", lambda one: one)
    show, blackout = head.show, head.blackout
    parameters = MqttParameters(broker=f"mqtt://127.0.0.1:{port}", blackout_after=0.2)
    with EmbeddedBroker("127.0.0.1", port):
        service = MqttService(engine, ["Moving-head"], parameters)
        service.__enter__()
        one = Person(port)
        one.send("point", [1, 1, 0])
        state = one.state(lambda found: found["point"] == [1, 1, 0] and not found["moving"])
        head.blackout = lambda: (blackout(), went_dark.set())
        head.show = lambda look: (show(look), lit_again.set())
        one.close()
    assert went_dark.wait(PATIENCE_S)
    with EmbeddedBroker("127.0.0.1", port):
        assert lit_again.wait(PATIENCE_S)
        again = Person(port)
        assert again.state(lambda found: found["lit"])["channels"] == state["channels"]
        again.send("point", [1, -1, 0])  # its subscriptions are there as well
        again.state(lambda found: found["point"] == [1, -1, 0])
        again.close()
        service.__exit__()


FLOOD = """
import sys
import paho.mqtt.client as mqtt
client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
client.connect("127.0.0.1", int(sys.argv[1]))
client.loop_start()
for number in range(5000):
    client.publish("Moving-head/point", f"[{number / 5000}, 0.5, 0.0]", qos=0)
client.publish("Moving-head/point", f"[0.7, {sys.argv[2]}, 0.0]", qos=1).wait_for_publish(60.0)
client.disconnect()
client.loop_stop()
"""


@pytest.mark.slow
def test_in_a_flood_the_newest_point_wins_and_memory_stays(person):
    process, used = psutil.Process(), []
    for y in (0.1, 0.2, 0.3):
        subprocess.run([sys.executable, "-c", FLOOD, str(person.port), str(y)], check=True, timeout=120)
        person.state(lambda one, y=y: one["point"] == [0.7, y, 0.0])
        used.append(process.memory_info().rss)
    assert used[-1] - used[0] < 10e6, used


def test_users_and_passwords(engine, tmp_path):
    port = free_port()
    secret = tmp_path / "users"
    program = shutil.which("mosquitto_passwd")
    if not program:
        pytest.skip("there is no mosquitto_passwd")
    subprocess.run([program, "-b", "-c", str(secret), "ann", "p@ss"], check=True, capture_output=True)
    with mosquitto(port, tmp_path, f"password_file {secret}"):
        parameters = MqttParameters(broker=f"mqtt://ann:p%40ss@127.0.0.1:{port}")
        with MqttService(engine, ["Moving-head"], parameters) as service:
            wait_until(lambda: service.devices[0].is_connected)

    lines = queue.Queue()
    with mosquitto(port, tmp_path, f"password_file {secret}"):
        parameters = MqttParameters(broker=f"mqtt://127.0.0.1:{port}", user="ann", password="wrong")
        with MqttService(engine, ["Moving-head"], parameters, lines.put):
            assert "Moving-head: the broker refuses the connection: Not authorized" in lines.get(timeout=PATIENCE_S)


def test_a_broker_that_is_absent_lost_and_back_is_reported(engine):
    port, lines = free_port(), queue.Queue()
    with MqttService(engine, ["Moving-head"], MqttParameters(broker=f"mqtt://127.0.0.1:{port}"), lines.put):
        assert lines.get(timeout=PATIENCE_S) == "Moving-head: the broker cannot be reached; tried again and again"
        with EmbeddedBroker("127.0.0.1", port):
            assert lines.get(timeout=PATIENCE_S) == "Moving-head: the broker is there again"
        assert lines.get(timeout=PATIENCE_S) == "Moving-head: the broker is lost"


@pytest.mark.parametrize(
    ("module", "words"),
    [("paho.mqtt.client", "MQTT needs paho-mqtt"), ("amqtt.broker", "the embedded broker needs amqtt")],
)
def test_what_is_not_installed_is_named_with_its_command(engine, monkeypatch, module, words):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(UserError, match=rf"{words}; run: pip install 'daidalos\[industry\]'"):
        MqttService(engine, ["Moving-head"], MqttParameters(port=free_port())).__enter__()


def test_tls(engine, tmp_path):
    port, certificate, key = free_port(), tmp_path / "c.pem", tmp_path / "k.pem"
    make_certificate(certificate, key)
    with mosquitto(port, tmp_path, f"certfile {certificate}\nkeyfile {key}\nallow_anonymous true"):
        parameters = MqttParameters(broker=f"mqtts://localhost:{port}", ca_file=str(certificate))
        with MqttService(engine, ["Moving-head"], parameters) as service:
            assert service.url == f"mqtts://localhost:{port}"
            wait_until(lambda: service.devices[0].is_connected)
    with pytest.raises(UserError, match="cannot read the certificates of MQTT"):
        MqttService(engine, ["Moving-head"], MqttParameters(broker="mqtts://localhost", ca_file="none")).__enter__()


def make_certificate(certificate, key):
    """Write a certificate of localhost that signs itself."""
    x509 = pytest.importorskip("cryptography.x509")
    from datetime import datetime, timedelta

    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec

    private = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, "localhost")])
    now = datetime(2020, 1, 1)
    signed = (
        x509.CertificateBuilder(name, name, private.public_key(), 1, now, now + timedelta(days=36500))
        .add_extension(x509.SubjectAlternativeName([x509.DNSName("localhost")]), critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(private, hashes.SHA256())
    )
    certificate.write_bytes(signed.public_bytes(serialization.Encoding.PEM))
    key.write_bytes(
        private.private_bytes(
            serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
    )


def wait_until(holds):
    """Wait for a condition of another thread."""
    ended = threading.Event()
    for _ in range(int(PATIENCE_S / 0.01)):
        if holds():
            return
        ended.wait(0.01)
    raise AssertionError("it did not become true")


@pytest.mark.parametrize(
    ("url", "found"),
    [
        ("mqtt://host", Address("host", 1883, False, "", "")),
        ("mqtts://ann:p%40ss@host:99", Address("host", 99, True, "ann", "p@ss")),
    ],
)
def test_urls_of_brokers(url, found):
    assert parse_url(url) == found


@pytest.mark.parametrize("url", ["mqt://host", "host:1883", "mqtt://", "mqtt://host:70000", ""])
def test_what_is_no_url_is_named(url):
    with pytest.raises(UserError, match="is no URL of a broker"):
        parse_url(url)


def test_a_port_in_use_is_named(engine):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(UserError, match=f"the embedded broker cannot listen at 127.0.0.1:{port}"):
            MqttService(engine, [], MqttParameters(port=port)).__enter__()


@given(st.sampled_from(messages.PROPERTIES), st.binary(max_size=60))
def test_no_message_ends_in_a_traceback(name, payload):
    try:
        messages.parse(name, payload)
    except messages.MessageError as error:
        assert "\n" not in str(error)  # noqa: PT017


json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["buckets", "channel", "value"]), inner)
    ),
    max_leaves=8,
)


@given(st.sampled_from(messages.PROPERTIES), json_values)
def test_no_value_ends_in_a_traceback(name, value):
    try:
        content = messages.parse(name, json.dumps(value).encode())
    except messages.MessageError:
        return
    if name == messages.POINT:
        assert len(content) == 3
        assert all(math.isfinite(one) for one in content)
    if name == messages.DASHBOARD:
        assert all(type(one) is int for pair in content.items() for one in pair)


def test_changes_of_a_look():
    found = messages.apply_look(Look(), {"color": "#ff0000", "zoom_deg": 10})
    assert found == Look(color=(1.0, 0.0, 0.0), zoom=pytest.approx(math.radians(10)))
