"""Wide-angle cameras: fisheye and other lenses that see more than a pinhole."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from daidalos.common.pose3 import Pose
from daidalos.common.suggestions import hint
from daidalos.description.link import Sensor as Description
from daidalos.description.markup import Element
from daidalos.samples.sensors import CameraInfoSample, Sample
from daidalos.simulation.contracts import ComponentContext
from daidalos.simulation.rendering.wide_lens import FUNCTIONS, MAPPINGS, Mapping, WideLens
from daidalos.simulation.sensors.camera import Camera, CameraOutput, Trigger, info_of

if TYPE_CHECKING:
    from daidalos.simulation.rendering.wide_renderer import WideRenderer


class WideAngleCamera(Camera):
    """Camera sensor whose lens maps angles to the picture as SDF's ``<lens>`` says.

    Attributes
    ----------
    lenses : list of WideLens
        Of the outputs.
    """

    names = ("wideanglecamera", "wide_angle_camera")

    def __init__(self, description: Description, context: ComponentContext) -> None:
        self.lenses: list[WideLens] = []
        super().__init__(description, context)
        for element, lens in zip(self.elements, self.lenses, strict=True):
            if not lens.calibration[0]:
                context.warn(
                    f"{element.where}: sensor {self.name!r}: no distortion model of camera_info describes its lens "
                    "within half a pixel; it is published as uncalibrated"
                )

    def _check(self, element: Element) -> None:
        self.lenses.append(read_lens(element, self.context))

    def start(self) -> Trigger:
        """Create the renderers anew, since a plugin may have changed their settings."""
        self._wide: dict[int, WideRenderer] = {}
        return super().start()

    def _pictures(
        self, number: int, output: CameraOutput, wanted: set[str], pose: Pose, now_ns: int
    ) -> Iterable[Sample]:
        from daidalos.simulation.rendering.camera_renderer import encode
        from daidalos.simulation.rendering.wide_renderer import WideRenderer

        settings = output.settings
        if output.image not in wanted:
            return
        if number not in self._wide:
            lens = self.lenses[number]
            self._wide[number] = WideRenderer(lens, settings.near, settings.far, settings.mask, settings.noise)
        start = int(self.random.integers(1 << 30)) if settings.noise.stddev else 0
        picture = self._wide[number].picture(self.instance.physics, pose, start)
        yield self._image(output.image, output, encode(picture, settings.encoding), settings.encoding, now_ns)

    def _info(self, number: int, topic: str, now_ns: int) -> CameraInfoSample:
        return info_of(self.outputs[number], topic, now_ns, *self.lenses[number].calibration)


def read_lens(element: Element, context: ComponentContext) -> WideLens:
    """Read the ``<lens>`` of a ``<camera>``.

    Raises
    ------
    DescriptionError
        When a type, function or number makes no sense.
    """
    empty = Element("lens", source=element.source, line=element.line)
    lens = element.first("lens") or empty
    image = element.first("image") or empty
    kind = lens.text_of("type", default="stereographic")
    if kind not in (*MAPPINGS, "custom"):
        raise lens.error(f"<type> is {kind!r}{hint(kind, (*MAPPINGS, 'custom'))}")
    mapping = _custom(lens.first("custom_function") or lens) if kind == "custom" else MAPPINGS[kind]
    if lens.flag_of("scale_to_hfov", default=True):
        half = element.number_of("horizontal_fov", default=1.047) / 2
        if half > mapping.widest:
            context.warn(
                f"{element.where}: <horizontal_fov> is {2 * half:g}, a lens of type {kind!r} is scaled to "
                f"{2 * mapping.widest:.3g} rad of it"
            )
        mapping = mapping.scaled(min(half, mapping.widest))
        if not 0 < mapping.f < np.inf:
            raise lens.error(f"<horizontal_fov> {2 * half:g} has no place in the picture of this <custom_function>")
    cutoff = lens.number_of("cutoff_angle", default=1.5707)
    if not 0 < cutoff <= np.pi + 1e-3:
        raise lens.error(f"<cutoff_angle> should be above 0 and at most pi, got {cutoff:g}")
    texture = lens.integer_of("env_texture_size", default=256)
    if not 4 <= texture <= 2048:
        raise lens.error(f"<env_texture_size> should be between 4 and 2048, got {texture}")
    width, height = image.integer_of("width", default=320), image.integer_of("height", default=240)
    return WideLens(width, height, mapping, cutoff, texture)


def _custom(element: Element) -> Mapping:
    fun = element.text_of("fun", default="tan")
    if fun not in FUNCTIONS:
        raise element.error(f"<fun> is {fun!r}, expected one of {', '.join(FUNCTIONS)}")
    c1, c2, f = (element.number_of(key, default=1.0) for key in ("c1", "c2", "f"))
    for key, value in (("c1", c1), ("c2", c2), ("f", f)):
        if not value > 0:
            raise element.error(f"<{key}> should be above 0, got {value:g}")
    return Mapping(c1, c2, element.number_of("c3", default=0.0), f, fun)
