"""Common base of controllers with velocity references of a mobile base."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

import numpy as np

from daidalos.control.base_odometry import BaseOdometry
from daidalos.control.contracts import Controller, ControllerContext, Subscription
from daidalos.control.velocity_input import VelocityInput
from daidalos.samples.sensors import OdometrySample, Sample, TransformSample


class BaseController(Controller):
    """Controller of a mobile base that publishes its odometry and its state.

    Attributes
    ----------
    state_sample : type
        Class attribute: what it tells on ``~/controller_state``.
    input : VelocityInput
        The velocities that are commanded.
    odometry : BaseOdometry
        Made by a subclass when it is configured.
    """

    state_sample: ClassVar[type[Sample]]
    odometry: BaseOdometry

    def __init__(self, parameters: Any, context: ControllerContext) -> None:
        self.input = VelocityInput(self)
        super().__init__(parameters, context)

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Odometry, its transform, and the wheels."""
        topics: dict[str, type[Sample]] = {"~/odometry": OdometrySample, "~/controller_state": self.state_sample}
        if self.parameters.enable_odom_tf:
            topics["~/tf_odometry"] = TransformSample
        return topics

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Commanded velocity."""
        return self.input.subscription("~/reference", self.parameters.use_stamped_vel)

    def activate(self, now_ns: int) -> None:
        """Reset the odometry."""
        self.input.reset()
        self.odometry.reset()
        self.references.values[:] = np.nan

    def odometry_samples(self, now_ns: int) -> Iterator[Sample]:
        """Yield the odometry, and its transform if enabled."""
        yield self.odometry.sample(now_ns, "~/odometry")
        if self.parameters.enable_odom_tf:
            yield self.odometry.transform(now_ns, "~/tf_odometry")
