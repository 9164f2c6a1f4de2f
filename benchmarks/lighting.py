"""How exactly a calibrated moving head points, and what heads cost: Monte Carlo and processor time."""

from __future__ import annotations

import json
import math
import socket
import threading
import time

import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.industry.lighting import artnet
from daidalos.industry.lighting.calibration import Observation, calibrate, grid, miss
from daidalos.industry.lighting.device import MqttParameters
from daidalos.industry.lighting.engine import Engine
from daidalos.industry.lighting.fixture_file import read_fixture
from daidalos.industry.lighting.head import Head
from daidalos.industry.lighting.kinematics import Angles, Geometry, off_axis_angle
from daidalos.industry.lighting.law_of_sines import distance_to_end
from daidalos.industry.lighting.mqtt_service import MqttService
from daidalos.industry.lighting.outputs import ArtNetOutput
from daidalos.industry.lighting.show import Show

CORNERS = [(x, y) for x in (-1.0, 1.0) for y in (-0.75, 0.75)]
START = Geometry(Pose.from_xyz_rpy((0.0, 0.0, 2.5), (math.pi, 0.0, 0.0)))
TRIALS = 200


def run() -> dict[str, float | str]:
    """Measure everything."""
    one, both, heights = (worst_errors(*case) for case in ((1, (0.0,)), (2, (0.0,)), (2, (0.0, 0.8))))
    sines = law_of_sines_errors()
    return {
        "lighting.calibrated_4_points_worst_median_mm": one[0],
        "lighting.calibrated_4_points_both_flips_worst_median_mm": both[0],
        "lighting.calibrated_4_points_both_flips_worst_95_percent_mm": both[1],
        "lighting.calibrated_8_points_both_flips_worst_median_mm": heights[0],
        "lighting.law_of_sines_median_mm": sines[0],
        "lighting.law_of_sines_95_percent_mm": sines[1],
        "lighting.40_heads_at_44_hz_cpu_percent": cpu_of_heads(40),
        **mqtt_latency(),
    }


def worst_errors(flips: int, heights: tuple[float, ...]) -> tuple[float, float]:
    """Return median and 95th percentile of the worst error over a table of 2 x 1.5 m [mm].

    The head hangs 2.8 m above it, up to half a metre beside its middle, with tilt zero and skews of 0.3 to 0.5 degrees;
    pan and tilt are read with 0.02 degrees of noise. The cone of 1.5 degrees about the pan axis, into which the skews
    let no beam, is left out.
    """
    rng = np.random.default_rng(1)
    found = []
    for _ in range(TRIALS):
        true = random_head(rng)
        points = [(x, y, z) for z in heights for x, y in CORNERS]
        observations = [
            Observation(point, noisy(angles, 0.02, rng)) for point in points for angles in true.solutions(point)[:flips]
        ]
        geometry = calibrate(observations, START).geometry
        targets = [one for one in grid((-1.0, -0.75), (1.0, 0.75), 0.0) if off_axis_angle(true, one) > 0.026]
        found.append(max(miss(true, geometry.solutions(target)[0], target) for target in targets))
    return 1e3 * float(np.median(found)), 1e3 * float(np.percentile(found, 95))


def random_head(rng: np.random.Generator) -> Geometry:
    """Return a head with a random pose and random angles."""
    position = (rng.uniform(-0.5, 0.5), rng.uniform(-0.4, 0.4), 2.8)
    rpy = (math.pi + 0.02 * rng.normal(), 0.02 * rng.normal(), rng.uniform(-3.0, 3.0))
    angles = np.radians(rng.uniform(0.3, 0.5, 3)) * rng.choice([-1, 1], 3)
    return Geometry(Pose.from_xyz_rpy(position, rpy), *(float(one) for one in angles))


def noisy(angles: Angles, deviation_deg: float, rng: np.random.Generator) -> Angles:
    error = np.radians(deviation_deg) * rng.normal(size=2)
    return Angles(angles.pan + float(error[0]), angles.tilt + float(error[1]))


def law_of_sines_errors() -> tuple[float, float]:
    """Return median and 95th percentile of the error of a distance [mm] with 0.05 degrees of noise on both angles."""
    rng = np.random.default_rng(1)
    found = []
    for _ in range(2000):
        head = np.array([rng.uniform(-0.5, 0.5), rng.uniform(-0.4, 0.4), 2.8])
        ends = np.array([[-1.0, -0.75, 0.0], [0.0, -0.75, 0.0], [1.0, -0.75, 0.0]]) - head
        units = ends / np.linalg.norm(ends, axis=1)[:, None]
        whole, half = (float(np.arccos(units[one] @ units[2]) + np.radians(0.05) * rng.normal()) for one in (0, 1))
        found.append(abs(distance_to_end(2.0, whole, half).distance - float(np.linalg.norm(ends[2]))))
    return 1e3 * float(np.median(found)), 1e3 * float(np.percentile(found, 95))


def cpu_of_heads(count: int, seconds: float = 5.0) -> float:
    """Return the share of a processor core [%] that heads need which all move all the time."""
    fixture = read_fixture("zema_13_channel")
    geometry = Geometry(Pose.from_xyz_rpy((0.0, 0.0, 2.8), (math.pi, 0.0, 0.0)))
    heads = [Head(f"h{n}", fixture, geometry, 1 + n // 20, 1 + 13 * (n % 20)) for n in range(count)]
    with Engine(Show(heads), [ArtNetOutput(port=1)]) as engine:
        start, begin = time.process_time(), time.monotonic()
        turn = 0
        while time.monotonic() - begin < seconds:
            for head in heads:
                engine.command(head.name, lambda one, x=(-1.0) ** turn: one.point((x, 1.0, 0.0)))
            turn += 1
            time.sleep(0.8)
        used, passed = time.process_time() - start, time.monotonic() - begin
    return 100 * used / passed


def mqtt_latency(count: int = 300) -> dict[str, float]:
    """Return how long a value takes from its publication over the embedded broker to its Art-Net packet [ms]."""
    import paho.mqtt.client as mqtt

    head = Head("Moving-head", read_fixture("zema_13_channel"), START)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver, socket.socket() as probe:
        receiver.bind(("127.0.0.1", 0))
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
        probe.close()
        with (
            Engine(Show([head]), [ArtNetOutput(port=receiver.getsockname()[1])]) as engine,
            MqttService(engine, [head.name], MqttParameters(port=port)),
        ):
            online = threading.Event()
            client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
            client.on_message = lambda *_: online.set()
            client.connect("127.0.0.1", port)
            client.subscribe("Moving-head/availability")
            client.loop_start()
            online.wait()
            times = [_one_latency(client, receiver, 1 + number % 250) for number in range(count)]
            client.disconnect()
            client.loop_stop()
    return {
        "lighting.mqtt_to_dmx_median_ms": 1e3 * float(np.median(times)),
        "lighting.mqtt_to_dmx_99_percent_ms": 1e3 * float(np.percentile(times, 99)),
    }


def _one_latency(client: object, receiver: socket.socket, value: int) -> float:
    time.sleep(0.03 + 0.03 * value / 250)
    payload = json.dumps({"buckets": [{"channel": 6, "value": value}]})
    start = time.perf_counter()
    client.publish("Moving-head/dashboard", payload)  # type: ignore[attr-defined]
    while artnet.parse_dmx(receiver.recv(2048)).data[5] != value:
        pass
    return time.perf_counter() - start
