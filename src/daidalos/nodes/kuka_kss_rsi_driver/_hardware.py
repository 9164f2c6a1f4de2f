"""A robot on a KUKA controller as hardware of ros2_control, corrected by RSI."""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.control.contracts import Hardware, HardwareContext
from daidalos.control.errors import HardwareError
from daidalos.description.ros2_control import HardwareInfo
from daidalos.industry.robots.kuka import controller_angles, joint_angles
from daidalos.industry.rsi.client import DEFAULT_PORT, LOOPBACK, ConnectionLost, NoTelegram, RsiClient
from daidalos.industry.rsi.telegrams import AXES, Telegram

_CONNECT_S = 30.0
_LOOK_S = 0.1
TIMEOUT = 1.0
"""Silence after which the robot counts as lost [s]; it watches the answers itself, and stops much earlier."""
MAX_SPEED = 30.0
"""Greatest speed of a commanded axis [deg/s]."""


class KukaRsiSystem(Hardware):
    """Robot of a KR C4 or C5 whose six axes are corrected by RSI, in the order of the ``<ros2_control>`` element.

    The controller executes `RSI_ON(#ABSOLUTE)` with `AK` in its Ethernet configuration. Each telegram is answered at
    once, in a thread of its own, on the way to what was commanded last; so the robot loses no answer when the manager
    is late. Parameters are ``client_ip``, the own address (loopback), ``client_port`` (59152), ``robot_ip`` (the first
    that sends where absent), ``sensor`` (`ImFree`), ``connect_timeout`` (30 s), ``timeout`` (1 s), the silence after
    which the robot counts as lost, ``max_speed`` (30 deg/s) of an axis, and ``axes``: ``direct`` where joints are the
    controller's axes in radians, as in KUKA's descriptions, ``arm`` for the built-in ones.
    """

    names = ("kuka_kss_rsi_driver/KukaRSIHardwareInterface",)

    def __init__(self, info: HardwareInfo, context: HardwareContext | None = None) -> None:
        super().__init__(info, context)
        if len(info.joints) != len(AXES):
            raise HardwareError(f"'{info.name}' needs six joints, it has {len(info.joints)}")
        for joint in info.joints:
            if [one.name for one in joint.commands if one.name != "position"]:
                raise HardwareError(f"joint '{joint.name}': only position can be commanded by RSI")
        self._joints = [joint.name for joint in info.joints]
        self._is_direct = info.parameters.get("axes", "direct") == "direct"
        if info.parameters.get("axes", "direct") not in ("direct", "arm"):
            raise HardwareError(f"'{info.name}': axes is '{info.parameters['axes']}', but direct or arm is expected")
        self._timeout = self._parameter("timeout", TIMEOUT)
        self._max_speed = self._parameter("max_speed", MAX_SPEED)
        self._client: RsiClient | None = None
        self._answering: threading.Thread | None = None
        self._lock = threading.Lock()
        self._ending = threading.Event()
        self._first = threading.Event()
        self._reset()

    def _reset(self) -> None:
        self._start: NDArray[np.float64] | None = None
        self._axes = np.zeros(6)
        self._correction = np.zeros(6)
        self._goal: NDArray[np.float64] | None = None
        self._last_ipoc = 0
        self._seen = self._read = 0
        self._silence = 0.0
        self._lost = ""
        self._is_active = False
        self._ending.clear()
        self._first.clear()

    def configure(self) -> None:
        """Open the port, and wait until the robot sends."""
        given = self.info.parameters
        self._reset()
        try:
            port = int(given.get("client_port") or DEFAULT_PORT)
            self._client = RsiClient(
                given.get("client_ip") or LOOPBACK, port, given.get("sensor") or "ImFree", given.get("robot_ip") or None
            )
        except (UserError, ValueError) as error:
            raise HardwareError(f"'{self.info.name}': {error}") from None
        self._answering = threading.Thread(target=self._answer, name="rsi", daemon=True)
        self._answering.start()
        if not self._first.wait(self._parameter("connect_timeout", _CONNECT_S)) or self._lost:
            reason = self._lost or "no telegram of the robot came"
            self.cleanup()
            raise HardwareError(f"'{self.info.name}': {reason}")
        self._take(0.0)

    def cleanup(self) -> None:
        """Close the port; the robot then stops by itself."""
        self._ending.set()
        if self._answering is not None:
            self._answering.join()
        if self._client is not None:
            self._client.close()
        self._client = self._answering = None

    def activate(self) -> None:
        """Take commands from now on."""
        with self._lock:
            self._goal, self._is_active, self._silence = None, True, 0.0
        self.commands.values[:] = np.nan

    def deactivate(self) -> None:
        """Hold the correction that the robot has."""
        with self._lock:
            self._goal, self._is_active = None, False

    def read(self, now_ns: int, period: float) -> None:
        """Take the newest angles."""
        if self._client is None:
            return
        self._take(period)
        if not self._is_active:
            return
        if self._lost:
            raise HardwareError(f"'{self.info.name}': {self._lost}")
        if self._silence > self._timeout:
            raise HardwareError(f"'{self.info.name}': no telegram of the robot for {self._silence:.3g} s")

    def write(self, now_ns: int, period: float) -> None:
        """Set the commanded angles; joints that nobody commands stay where they are."""
        if not self._is_active:
            return
        with self._lock:
            present = self._to_joints(np.radians(self._set_axes()))
            wanted = np.array([self.commands[f"{name}/position"] for name in self._joints])
            if np.isnan(wanted).all():
                return
            if np.isinf(wanted).any():
                raise HardwareError(f"'{self.info.name}': a commanded position is not finite")
            self._goal = np.degrees(self._to_axes(np.where(np.isnan(wanted), present, wanted)))

    def _parameter(self, name: str, default: float) -> float:
        text = self.info.parameters.get(name) or str(default)
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and value > 0.0):
            raise HardwareError(f"'{self.info.name}': {name} is '{text}', but must be greater than 0")
        return value

    def _take(self, period: float) -> None:
        with self._lock:
            seen, axes = self._seen, self._axes.copy()
        self._silence = self._silence + period if seen == self._read else 0.0
        moved = seen != self._read
        self._read = seen
        if not moved:
            return
        for name, position in zip(self._joints, self._to_joints(np.radians(axes)).tolist(), strict=True):
            if f"{name}/velocity" in self.states and period > 0.0:
                self.states[f"{name}/velocity"] = (position - self.states[f"{name}/position"]) / period
            self.states[f"{name}/position"] = position

    def _answer(self) -> None:
        """Answer the robot, in the thread of RSI."""
        assert self._client is not None
        while not self._ending.is_set():
            try:
                self._client.answer(self._correct, _LOOK_S)
            except NoTelegram:
                continue
            except (ConnectionLost, HardwareError) as error:
                self._lost = str(error)
                self._first.set()
                return

    def _correct(self, telegram: Telegram) -> Mapping[str, Mapping[str, float]]:
        """Return the correction of the axes for a telegram, a step nearer to the goal."""
        actual = telegram.groups.get("AIPos", {})
        if any(name not in actual for name in AXES):
            raise HardwareError("the robot's telegram has no AIPos with A1 to A6")
        with self._lock:
            self._axes = np.array([actual[name] for name in AXES])
            if self._start is None:
                self._start = self._axes.copy()
                self._last_ipoc = telegram.ipoc
            step = self._max_speed * 1e-3 * (telegram.ipoc - self._last_ipoc)
            if self._goal is not None:
                self._correction += np.clip(self._goal - self._set_axes(), -step, step)
            self._last_ipoc = telegram.ipoc
            self._seen += 1
            self._first.set()
            return {"AK": dict(zip(AXES, self._correction.tolist(), strict=True))}

    def _set_axes(self) -> NDArray[np.float64]:
        """Return the axes that the robot is corrected to (6,) [deg]."""
        out: NDArray[np.float64] = (self._axes if self._start is None else self._start) + self._correction
        return out

    def _to_joints(self, axes: NDArray[np.float64]) -> NDArray[np.float64]:
        return axes if self._is_direct else joint_angles(axes)

    def _to_axes(self, joints: NDArray[np.float64]) -> NDArray[np.float64]:
        return joints if self._is_direct else controller_angles(joints)
