"""A controller that drives after a carrot: a point of the path some way ahead."""

import math
from dataclasses import dataclass

import numpy as np

from daidalos.common.parameters import Parameters, parameter
from daidalos.common.pose2 import between
from daidalos.navigation.contracts import Controller


@dataclass(frozen=True)
class CarrotParameters(Parameters):
    """Parameters of the controller."""

    distance: float = parameter(0.4, "Distance of the carrot.", unit="m", above=0.0)
    speed: float = parameter(0.3, "Speed ahead.", unit="m/s", above=0.0)
    gain: float = parameter(2.0, "Turn rate per angle to the carrot.", unit="1/s", minimum=0.0)


class CarrotController(Controller):
    """Drives at one speed and turns to the carrot, whatever is in the way."""

    Parameters = CarrotParameters

    def __init__(self, parameters=None, context=None):
        super().__init__(parameters, context)
        self.limit = math.inf

    @property
    def look_ahead(self):
        return self.parameters.distance + 0.5

    def compute_velocity_commands(self, control):
        ahead = between(control.pose, control.path)
        far = np.flatnonzero(np.hypot(ahead[:, 0], ahead[:, 1]) >= self.parameters.distance)
        carrot = ahead[far[0] if far.size else -1]
        angle = math.atan2(carrot[1], carrot[0])
        speed = min(self.parameters.speed, self.limit) * max(math.cos(angle), 0.0)
        return np.array([speed, 0.0, self.parameters.gain * angle])

    def set_speed_limit(self, speed_limit, *, percentage):
        limit = self.parameters.speed * speed_limit / 100.0 if percentage else speed_limit
        self.limit = limit if speed_limit > 0.0 else math.inf

    def reset(self):
        pass
