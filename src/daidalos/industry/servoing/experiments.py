"""Runs of a seam servo through RSI: in the simulated cell, or with a robot."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daidalos.common.extensions import find
from daidalos.industry.rsi.client import LOOPBACK, ConnectionLost, NoTelegram, RsiClient
from daidalos.industry.rsi.configuration import Configuration
from daidalos.industry.rsi.controller import ControllerSettings
from daidalos.industry.rsi.controller_server import ControllerServer
from daidalos.industry.rsi.telegrams import Telegram, decode, encode
from daidalos.industry.servoing.butt_joint import ButtJoint, Seam
from daidalos.industry.servoing.contracts import SeamController
from daidalos.industry.servoing.extensions import SEAM_CONTROLLERS
from daidalos.industry.servoing.profile_sensor import ProfileSensor
from daidalos.industry.servoing.seam_servo import Cycle, Profiles, SeamServo, ServoSettings, State
from daidalos.industry.servoing.servo_cell import START, ServoCell, ToolMotion
from daidalos.industry.servoing.servo_run import COMPLETE, SERIES, ServoRun

WAIT = 5.0
"""Real time in which a telegram must come, and in the simulated cell its answer [s]."""
WARMING_CYCLES = 300
LOOK = 0.2
"""Real time after which a run that waits asks whether it is to be ended [s]."""
OFF = "off"
"""Name of the run without corrections."""

Watcher = Callable[[Cycle, NDArray[np.float64] | None], None]


@dataclass(frozen=True)
class CellOptions:
    """What a run in the simulated cell may have beside its seam.

    Attributes
    ----------
    seed : int
        Of the edges, the noise and the lost answers.
    irregularity : float
        Of the edges, from 0.
    lost : float
        Share of answers that get lost.
    blind : tuple of float, optional
        Lengths of the seam between which the sensor sees nothing [m].
    realtime : bool
        Whether cycles take their time, so that answers can be late.
    controller : ControllerSettings
    motion : ToolMotion
    """

    seed: int = 0
    irregularity: float = 1.0
    lost: float = 0.0
    blind: tuple[float, float] | None = None
    realtime: bool = False
    controller: ControllerSettings = field(default_factory=ControllerSettings)
    motion: ToolMotion = field(default_factory=ToolMotion)


class NoController(SeamController):
    """No corrections, to compare with."""

    def step(self, observation: object) -> float:
        """Return no correction."""
        return 0.0


class Recorder:
    """Recorder of the cycles of a run."""

    def __init__(self, offset: float = 0.0) -> None:
        self._offset = offset
        self._rows: list[tuple[float, ...]] = []
        self._last_s = -math.inf

    def __call__(self, cycle: Cycle, _: NDArray[np.float64] | None) -> None:
        """Record a cycle."""
        found = cycle.evaluation
        self._rows.append(
            (
                1e-3 * cycle.ipoc,
                cycle.s - self._offset,
                cycle.lateral,
                cycle.commanded,
                cycle.correction,
                cycle.seam,
                math.nan if found is None else found.quality,
                math.nan if found is None else found.gap,
            )
        )

    def run(
        self,
        seam: Seam,
        controller: str,
        ended: str,
        deviations: list[float],
        client: RsiClient,
        lost: int = 0,
    ) -> ServoRun:
        """Return the run of what was recorded, with the deviations of each cycle [m]."""
        columns = np.array(self._rows, dtype=np.float64).reshape(len(self._rows), 8)
        seen = client.statistics
        series = dict(zip(SERIES, columns.T, strict=False))
        series["time"] = series["time"] - (series["time"][0] if len(columns) else 0.0)
        series["deviation"] = np.array(deviations)
        series["duration"] = np.array(seen.durations)
        counts = {
            "cycles": seen.answered,
            "lost": lost,
            "missed": seen.missed,
            "repeated": seen.repeated,
            "refused": seen.refused,
        }
        return ServoRun(seam.name, controller, seam.length, ended, series, counts)


def controller_named(name: str, settings: ServoSettings) -> SeamController:
    """Return a seam controller by name, or that of no corrections.

    Raises
    ------
    UserError
        Where there is none of that name.
    """
    return NoController(settings.setup) if name == OFF else find(SEAM_CONTROLLERS, name)(settings.setup)


def run_in_cell(
    seam: Seam,
    name: str,
    configuration: Configuration,
    settings: ServoSettings | None = None,
    options: CellOptions | None = None,
    watcher: Watcher | None = None,
) -> ServoRun:
    """Follow a seam in the simulated cell, through RSI over UDP on this machine.

    Raises
    ------
    UserError
        Where there is no controller of that name.
    """
    settings, options = settings or ServoSettings(), options or CellOptions()
    controller = controller_named(name, settings)
    joint = ButtJoint(seam, options.seed, options.irregularity)
    cell = ServoCell(
        joint, configuration, settings.setup.speed, settings.sensor_lead, options.controller, options.motion,
        options.seed + 1, options.blind,
    )  # fmt: skip
    recorder, deviations = Recorder(START), list[float]()
    losing = np.random.default_rng(options.seed + 2)

    def watch(cycle: Cycle, heights: NDArray[np.float64] | None) -> None:
        recorder(cycle, heights)
        deviations.append(cell.deviation)
        if watcher is not None:
            watcher(cycle, heights)

    servo = SeamServo(controller, settings, cell.profile, watch)
    with (
        RsiClient(port=0, sensor=configuration.sensor) as client,
        ControllerServer(cell.controller, LOOPBACK, client.port) as server,
    ):
        begin, cycles = time.monotonic(), 0
        while not cell.controller.stopped and cell.s < seam.length:
            server.send()
            client.answer(servo, WAIT)
            cycles += 1
            end = begin + cycles * cell.controller.settings.cycle
            left = max(end - time.monotonic(), 0.0) if options.realtime else WAIT
            if losing.random() < options.lost:
                server.lose(left)
            else:
                server.receive(left)
            if options.realtime:
                time.sleep(max(end - time.monotonic(), 0.0))
        ended = servo.reason or cell.controller.stopped or COMPLETE
        return recorder.run(seam, name, ended, deviations, client, cell.controller.total_lost)


def warm_up(name: str, settings: ServoSettings) -> None:
    """Follow a simulated seam for some cycles, so that nothing is loaded or compiled when a robot waits for answers."""
    seam = Seam("warming", 0.1, np.zeros_like)
    sensor = ProfileSensor(ButtJoint(seam))
    servo = SeamServo(controller_named(name, settings), settings, lambda one: sensor.measure(0.0, 0.0))
    cosine, sine = math.cos(settings.heading), math.sin(settings.heading)
    for cycle in range(WARMING_CYCLES):
        place = {"X": 0.1 * cosine * cycle, "Y": 0.1 * sine * cycle}
        groups = servo(Telegram("Rob", "KUKA", cycle, {"RIst": place}))
        decode(encode(Telegram("Sen", "ImFree", cycle, {"RKorr": groups["RKorr"]})), "Sen")


def run_with_robot(
    client: RsiClient,
    seam: Seam,
    name: str,
    settings: ServoSettings,
    profiles: Profiles,
    wait: float,
    watcher: Watcher | None = None,
    is_ending: Callable[[], bool] = lambda: False,
) -> ServoRun:
    """Follow a seam with a robot that sends to a client, until the seam's length is over or the servo stops.

    Deviations are those of the robot's reported place from the seam that was mapped.

    Parameters
    ----------
    wait : float
        Time in which the robot must begin to send [s].
    is_ending : callable
        Returns whether the run is to be ended; asked every `LOOK` while nothing comes.

    Raises
    ------
    ConnectionLost
        When the robot does not begin to send; where it no longer sends, the run ends.
    """
    controller = controller_named(name, settings)
    recorder, deviations = Recorder(START), list[float]()
    last_s = -math.inf

    def watch(cycle: Cycle, heights: NDArray[np.float64] | None) -> None:
        nonlocal last_s
        last_s = cycle.s - START
        recorder(cycle, heights)
        deviations.append(cycle.lateral - float(seam.lateral(np.array([last_s]))[0]))
        if watcher is not None:
            watcher(cycle, heights)

    servo = SeamServo(controller, settings, profiles, watch)
    lost, waited = "", 0.0
    while last_s < seam.length and servo.state is not State.STOPPED and not lost:
        try:
            client.answer(servo, min(LOOK, wait))
            waited, wait = 0.0, WAIT
        except NoTelegram:
            waited += LOOK
            if is_ending():
                lost = "it was ended"
            elif waited >= wait:
                lost = f"no telegram of a robot came within {wait:g} s"
        except ConnectionLost as error:
            lost = str(error)
    if not deviations:
        raise ConnectionLost(lost)
    return recorder.run(seam, name, servo.reason or lost or COMPLETE, deviations, client)
