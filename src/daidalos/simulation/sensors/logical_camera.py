"""Logical camera: names and poses of the models in a frustum."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from daidalos.common.pose3 import Pose, rotation_matrix
from daidalos.description.markup import Element
from daidalos.samples.sensors import LogicalImageSample, Sample
from daidalos.simulation.contracts import Sensor
from daidalos.simulation.instance import LinkView


class LogicalCamera(Sensor):
    """Camera that recognizes every model in its frustum, regardless of occlusion."""

    names = ("logical_camera",)
    default_topic = "logical_camera"
    sample = LogicalImageSample

    def read(self, element: Element) -> None:
        """Read the frustum."""
        settings = element.first("logical_camera") or Element("logical_camera")
        self.near, self.far = settings.number_of("near", default=0.0), settings.number_of("far", default=1.0)
        self.angle = settings.number_of("horizontal_fov", default=1.0)
        self.aspect = settings.number_of("aspect_ratio", default=1.0)
        if not 0 <= self.near < self.far or not 0 < self.angle < math.pi or self.aspect <= 0:
            raise settings.error("expected 0 <= near < far, a field of view below pi and a positive aspect ratio")

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Return the models with a shape in the frustum."""
        physics = self.instance.physics
        eye = self.link.pose @ self.pose
        model, data = physics.model, physics.data
        centres = (data.geom_xpos - np.array(eye.position)) @ rotation_matrix(eye.orientation)
        # The radius of what is infinite is given as zero: a plane is seen nowhere.
        inside = self._reaches(centres, model.geom_rbound) & (model.geom_rbound > 0)
        names: dict[str, Pose] = {}
        for geom in np.flatnonzero(inside).tolist():
            if geom in physics.geoms:
                name = physics.geoms[geom][0]
                if name != self.instance.name and name not in names:
                    root = LinkView(physics, int(model.body_rootid[model.geom_bodyid[geom]]))
                    names[name] = eye.inverse @ root.pose
        yield LogicalImageSample(now_ns, self.topic, self.frame_id, eye, tuple(names.items()))

    def _reaches(self, centres: np.ndarray, radii: np.ndarray) -> np.ndarray:
        """Return for spheres (n, 3) in the camera frame whether they intersect the frustum."""
        x, y, z = centres.T
        across, along = math.tan(self.angle / 2), math.tan(self.angle / 2) / self.aspect
        inside: np.ndarray = (x + radii >= self.near) & (x - radii <= self.far)
        for side, slope in ((y, across), (-y, across), (z, along), (-z, along)):
            inside &= x * slope - side >= -radii * math.hypot(1.0, slope)
        return inside
