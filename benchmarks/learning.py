"""Steps a second of environments of Gymnasium, in seconds of processor time of the one process that steps them."""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np

ROUNDS = 7
ENVIRONMENTS: dict[str, tuple[int, dict[str, Any]]] = {
    "lidar": (2000, {"motion": "kinematic", "rays": 36}),
    "lidar_dynamics": (200, {"motion": "dynamics", "rays": 36}),
    "lidar_and_camera": (40, {"motion": "kinematic", "rays": 36, "camera": True}),
}
"""How many steps a round has, and the options."""


def run() -> dict[str, float | str]:
    """Measure the environments one by one, and eight that step together."""
    from daidalos.learning import WorldEnv, make_vector

    figures: dict[str, float | str] = {}
    for name, (count, options) in ENVIRONMENTS.items():
        speed = _speed(WorldEnv(max_steps=500, **options), count)
        figures[f"learning.{name}_steps_per_s"] = speed
    together = make_vector(8, max_steps=500, motion="kinematic", rays=36)
    figures["learning.lidar_eight_together_steps_per_s"] = 8.0 * _speed(together, 250)
    return figures


def _speed(env: Any, count: int) -> float:
    """Return the steps in a second of processor time, the median of some rounds of random actions."""
    env.action_space.seed(0)
    env.reset(seed=0)
    single = np.ndim(env.step(env.action_space.sample())[2]) == 0
    speeds = []
    for _ in range(ROUNDS):
        actions = [env.action_space.sample() for _ in range(count)]
        begun = time.process_time()
        for action in actions:
            _, _, done, late, _ = env.step(action)
            if single and (done or late):
                env.reset()
        speeds.append(count / (time.process_time() - begun))
    return statistics.median(speeds)
