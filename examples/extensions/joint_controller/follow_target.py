"""A controller of ros2_control: a joint follows a target."""

from dataclasses import dataclass

from daidalos.common.parameters import Parameters, parameter
from daidalos.control.contracts import Controller, Subscription
from daidalos.samples.controllers import ValuesCommand


@dataclass(frozen=True)
class FollowTargetParameters(Parameters):
    """Parameters of the controller."""

    joint: str = parameter("", "Joint that follows the target.", not_empty=True, read_only=True)
    gain: float = parameter(1.0, "Speed per distance to the target.", unit="1/s", minimum=0.0)


class FollowTarget(Controller):
    """Commands a joint's velocity in proportion to its distance from `~/target` (`std_msgs/msg/Float64MultiArray`)."""

    Parameters = FollowTargetParameters

    def configure(self):
        self.command_names = (f"{self.parameters.joint}/velocity",)
        self.state_names = (f"{self.parameters.joint}/position",)

    @property
    def subscriptions(self):
        return {"~/target": Subscription(ValuesCommand, self.take)}

    def take(self, command):
        self.target = command.values[0]

    def activate(self, now_ns):
        self.target = self.states.read()[0]

    def update(self, now_ns, period):
        self.commands.write(self.parameters.gain * (self.target - self.states.read()))
        return ()
