"""The flows in the real Node-RED and a real browser, over Mosquitto, to OLA as the receiver of Art-Net.

Node-RED is looked for in the folder that `DAIDALOS_NODE_RED` names, where npm has installed ``node-red`` and
``@flowfuse/node-red-dashboard``.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.parse
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from artnet_port import artnet_port
from browser.cdp import Chromium
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.configuration import DEFAULT, Configuration, read_configuration
from daidalos.industry.lighting.device import MqttParameters
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.mqtt_service import MqttService
from daidalos.industry.lighting.show import Show
from daidalos.interfaces.library import BUILT_IN
from mqtt_brokers import free_port, mosquitto
from places import MACHINE_TEMPORARY

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(180)]

WINDOW = (700, 1000)
PATIENCE_S = 40.0
NOBODY = 65534
_OTHER_PLUGINS = [
    "dummy",
    "e131",
    "espnet",
    "ftdidmx",
    "gpio",
    "karate",
    "kinet",
    "milinst",
    "opendmx",
    "openpixelcontrol",
    "osc",
    "pathport",
    "renard",
    "sandnet",
    "shownet",
    "spi",
    "stageprofi",
    "uartdmx",
    "usbdmx",
    "usbserial",
]


class Ola:
    """The Open Lighting Architecture as a receiver of Art-Net, within a ``with`` block."""

    def __init__(self) -> None:
        program = shutil.which("olad")
        if not program:
            pytest.skip("there is no olad; install the package ola")
        self._program, self._http = program, free_port()

    def __enter__(self) -> Ola:
        with ExitStack() as stack:
            stack.enter_context(artnet_port())
            # Not below pytest's folder, which nobody but its owner may enter.
            self._start(Path(stack.enter_context(tempfile.TemporaryDirectory(dir=MACHINE_TEMPORARY))))
            self._stack = stack.pop_all()
        return self

    def _start(self, settings: Path) -> None:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("", artnet.PORT))
            except OSError:
                pytest.skip("another program receives Art-Net here, and OLA takes no other port")
        for name in _OTHER_PLUGINS:
            (settings / f"ola-{name}.conf").write_text("enabled = false\n")
        (settings / "ola-artnet.conf").write_text(
            "enabled = true\nip = 127.0.0.1\nuse_loopback = true\noutput_ports = 0\n"
        )
        words = [self._program, "-c", str(settings), "-p", str(self._http), "-r", str(free_port())]
        if os.getuid() == 0:  # it refuses to run as root
            for one in (settings, *settings.iterdir()):
                os.chown(one, NOBODY, NOBODY)
            words = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", *words]
        self._process = subprocess.Popen(
            [*words, "--no-register-with-dns-sd"],
            env={**os.environ, "HOME": str(settings)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            until(lambda: "1-I-0" in json.dumps(self._ask("/json/get_ports")), self._process)
            self._ask("/new_universe", id="1", name="one", add_ports="1-I-0")
        except BaseException:
            self._process.kill()
            self._process.wait()
            raise

    def __exit__(self, *error: object) -> None:
        self._process.terminate()
        self._process.wait()
        self._stack.close()

    def levels(self) -> bytes:
        """Return what has arrived in universe 1."""
        return bytes(self._ask("/get_dmx?u=1")["dmx"])

    def _ask(self, path: str, **fields: str) -> Any:
        data = urllib.parse.urlencode(fields).encode() if fields else None
        with urllib.request.urlopen(f"http://127.0.0.1:{self._http}{path}", data, timeout=PATIENCE_S) as answer:
            return json.loads(answer.read() or b"null")


def until(holds: Callable[[], bool], process: subprocess.Popen[bytes] | None = None) -> None:
    """Wait until a condition holds; errors of the network mean not yet."""
    end = time.monotonic() + PATIENCE_S
    while True:
        try:
            if holds():
                return
        except OSError:
            pass
        assert process is None or process.poll() is None, "the program has ended"
        assert time.monotonic() < end, "it did not become true"
        time.sleep(0.05)


@contextmanager
def node_red(folder: Path, flow: str, **changes: str) -> Iterator[str]:
    """Run Node-RED with one of the flows, and yield the dashboard's address."""
    home = os.environ.get("DAIDALOS_NODE_RED")
    if not home or not (Path(home) / "node_modules" / "node-red" / "red.js").is_file():
        pytest.skip(
            "DAIDALOS_NODE_RED names no folder with Node-RED: npm install node-red@4 @flowfuse/node-red-dashboard@1"
        )
    port, user = free_port(), folder / "node-red"
    user.mkdir()
    (user / "node_modules").symlink_to(Path(home) / "node_modules")
    shutil.copy(Path(home) / "package.json", user)
    text = (BUILT_IN / "daidalos_lighting" / "node_red" / f"{flow}.json").read_text()
    for before, after in changes.items():
        assert f'"{before}": ' in text
        text = text.replace(f'"{before}": "1883"', f'"{before}": "{after}"')
    (user / "flows.json").write_text(text)
    (user / "settings.js").write_text(
        f"module.exports = {{ flowFile: 'flows.json', uiHost: '127.0.0.1', uiPort: {port}, userDir: {str(user)!r},"
        " logging: { console: { level: 'warn' } }, telemetry: { enabled: false } };"
    )
    words = ["node", str(Path(home) / "node_modules" / "node-red" / "red.js"), "--settings", str(user / "settings.js")]
    process = subprocess.Popen(words, cwd=user, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}/dashboard/head"
    try:
        until(lambda: urllib.request.urlopen(address, timeout=PATIENCE_S).status == 200, process)
        yield address
    finally:
        process.terminate()
        process.wait()


def angles(configuration: Configuration, levels: bytes) -> tuple[float, float]:
    """Return the pan and tilt that levels mean [deg]."""
    (head,) = configuration.make_heads()
    if len(levels) < head.last:
        return math.nan, math.nan
    found = head.angles_of(levels[head.first - 1 : head.last])
    return math.degrees(found.pan), math.degrees(found.tilt)


def test_a_click_on_the_table_and_a_colour_arrive_over_mqtt(browser: Chromium, tmp_path: Path) -> None:
    configuration, port = read_configuration(DEFAULT), free_port()
    show = Show(configuration.make_heads())
    wanted = configuration.make_heads()[0].point((0.5, -0.3, 0.0))
    pan, tilt = math.degrees(wanted.pan), math.degrees(wanted.tilt)
    with (
        Ola() as ola,
        mosquitto(port, tmp_path),
        Engine(show, configuration.make_outputs()) as engine,
        MqttService(engine, ["Moving-head"], MqttParameters(broker=f"mqtt://127.0.0.1:{port}")),
        node_red(tmp_path, "mqtt", port=str(port)) as address,
    ):
        browser.open(address)
        browser.wait_for("!!document.querySelector('.table-picture')")
        place = browser.evaluate(
            "(() => { const e = document.querySelector('.table-picture');"
            " const p = new DOMPoint(0.5, 0.3).matrixTransform(e.getScreenCTM()); return [p.x, p.y]; })()"
        )
        browser.click(*place)
        until(lambda: math.dist(angles(configuration, ola.levels()), (pan, tilt)) < 0.5)
        browser.wait_for(
            "Math.abs(document.querySelector('.table-picture circle[fill-opacity]')?.cx.baseVal.value - 0.5) < 0.02"
        )
        browser.evaluate(
            "(() => { const e = document.querySelector('input[type=color]'); e.value = '#ff0000';"
            " for (const kind of ['input', 'change', 'blur']) e.dispatchEvent(new Event(kind, { bubbles: true })); })()"
        )
        until(lambda: 10 <= ola.levels()[7] <= 14)  # red on the colour wheel
        if os.environ.get("DAIDALOS_PICTURES"):
            browser.screenshot(Path(os.environ["DAIDALOS_PICTURES"]) / "node_red.png")
        browser.open("about:blank")


def test_a_slider_arrives_by_artnet(browser: Chromium, tmp_path: Path) -> None:
    configuration = read_configuration(DEFAULT)
    with Ola() as ola, node_red(tmp_path, "artnet") as address:
        browser.open(address)
        slider = "document.querySelectorAll('.v-slider-thumb')[0]"
        browser.wait_for(f"!!{slider}")
        browser.evaluate(f"{slider}.focus()")
        browser.press("End")
        until(lambda: angles(configuration, ola.levels())[0] > 260.0)
        browser.open("about:blank")
