"""Cameras: colour, depth, multi-camera and segmentation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.description.link import Sensor as Description
from daidalos.description.markup import Element
from daidalos.samples.commands import FlagCommand, SignalCommand
from daidalos.samples.endpoint import Subscription
from daidalos.samples.sensors import (
    CameraInfoSample,
    ImageSample,
    PointCloudSample,
    Sample,
)
from daidalos.simulation.contracts import ComponentContext, Sensor
from daidalos.simulation.rendering.pool import Pool
from daidalos.simulation.sensors.camera_settings import WIDEST, CameraSettings, read_camera
from daidalos.simulation.topics import absolute_topic

if TYPE_CHECKING:
    from daidalos.simulation.rendering.camera_renderer import CameraRenderer


@dataclass
class CameraOutput:
    """One optical system of a camera sensor with its topics; a plugin may change it before it is used.

    Parameters
    ----------
    settings : CameraSettings
    image, depth, points, labels, colored_labels : str
        Absolute topics; empty for what is not published.
    infos : tuple of str
        Topics of the calibration.
    frame_id : str
        Of images: an optical frame, z ahead.
    points_frame_id : str
        Of points.
    points_ahead_x : bool
        Points in a frame with x ahead and z up rather than in an optical one.
    baseline : float
        Distance to the left camera of a stereo pair [m]; goes into the projection matrix.
    """

    settings: CameraSettings
    frame_id: str
    points_frame_id: str = ""
    image: str = ""
    depth: str = ""
    points: str = ""
    labels: str = ""
    colored_labels: str = ""
    infos: tuple[str, ...] = ()
    points_ahead_x: bool = False
    baseline: float = 0.0

    def topics(self) -> dict[str, type[Sample]]:
        """Return the topics with their sample classes."""
        pictures = (self.image, self.depth, self.labels, self.colored_labels)
        topics: dict[str, type[Sample]] = dict.fromkeys(pictures, ImageSample)
        topics |= {self.points: PointCloudSample}
        topics |= dict.fromkeys(self.infos, CameraInfoSample)
        return {topic: kind for topic, kind in topics.items() if topic}


@dataclass
class Trigger:
    """Whether an image was requested."""

    due: bool = False


class Camera(Sensor):
    """Camera sensor with one or several optical systems.

    Attributes
    ----------
    outputs : list of CameraOutput
    elements : list of Element
        The ``<camera>`` of each output.
    trigger : tuple of (str, type) or None
        The topic, and the class of its commands, that makes it look; None where it looks by itself.
    """

    state: Trigger

    names: ClassVar[tuple[str, ...]] = (
        *("camera", "depth", "depth_camera", "rgbd", "rgbd_camera", "multicamera"),
        *("segmentation", "segmentation_camera"),
    )
    default_topic = "image"

    def __init__(self, description: Description, context: ComponentContext) -> None:
        self.kind = description.type.removesuffix("_camera")
        super().__init__(description, context)
        self.elements = description.element.all("camera") or [Element("camera")]
        self.outputs = [self._output(element, several=len(self.elements) > 1) for element in self.elements]
        for element in self.elements:
            self._check(element)
        for output in self.outputs[1:]:
            # To the right of the first camera, as a stereo pair's projection matrices tell it.
            output.baseline = -(self.outputs[0].settings.pose.inverse @ output.settings.pose).position[1]
        self._renderers: list[CameraRenderer] = []
        first = self.outputs[0].settings
        trigger = absolute_topic(first.trigger_topic or f"{self.topic}/trigger", context.namespace)
        self.trigger: tuple[str, type] | None = (trigger, FlagCommand) if first.triggered else None

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Images, calibrations and points of all outputs."""
        return {topic: kind for output in self.outputs for topic, kind in output.topics().items()}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """Topic that triggers an image, if the camera is triggered."""
        return {self.trigger[0]: Subscription(self.trigger[1], self._pull_trigger)} if self.trigger else {}

    def _pull_trigger(self, command: FlagCommand | SignalCommand) -> None:
        self.state.due = isinstance(command, SignalCommand) or command.value

    def start(self) -> Trigger:
        """Create the renderers anew, since a plugin may have changed their settings."""
        self._renderers = []
        self._pool = Pool()
        self._rays: dict[int, NDArray[np.float32]] = {}
        return Trigger()

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Return the images unless a trigger is awaited."""
        if self.trigger and not self.state.due:
            return ()
        self.state.due = False
        return self.measure(now_ns)

    def measure(self, now_ns: int) -> Iterable[Sample]:
        """Render the outputs that have subscribers, unless there is no time for it."""
        has_subscribers = self.instance.has_subscribers
        drawn = None
        for number, output in enumerate(self.outputs):
            wanted = {topic for topic in output.topics() if has_subscribers(topic)}
            if drawn is None and wanted - set(output.infos):
                drawn = self.trigger is not None or self.instance.can_draw(self.topic, now_ns)
            if wanted and drawn is not False:
                yield from self._capture(number, output, wanted, now_ns)

    def _output(self, element: Element, several: bool) -> CameraOutput:
        """Read an output and give it the topics that gz would."""
        settings = read_camera(element)
        output = CameraOutput(settings, settings.optical_frame or self.frame_id, self.frame_id, points_ahead_x=True)
        description_topic = settings.topic or self.topic
        base = absolute_topic(description_topic, self.context.namespace)
        stem = base.removesuffix("/image") if base == self.topic else base
        if several:
            stem = f"{stem}/{settings.name}"
            base = f"{stem}/image"
        folder = base.rpartition("/")[0]
        info = settings.info_topic or f"{folder}/camera_info"
        if self.kind == "depth":
            output.depth = f"{stem}/depth_image" if base.endswith("/image") else base
            output.points = f"{output.depth}/points"
        elif self.kind == "rgbd":
            output.image, output.depth, output.points = f"{stem}/image", f"{stem}/depth_image", f"{stem}/points"
            info = settings.info_topic or f"{stem}/camera_info"
        elif self.kind == "segmentation":
            output.labels, output.colored_labels = f"{stem}/labels_map", f"{stem}/colored_map"
            info = settings.info_topic or f"{stem}/camera_info"
        else:
            output.image = base
        output.infos = (absolute_topic(info, self.context.namespace),)
        return output

    def _capture(self, number: int, output: CameraOutput, wanted: set[str], now_ns: int) -> Iterable[Sample]:
        if wanted - set(output.infos):
            pose = self.link.pose @ self.pose @ output.settings.pose
            yield from self._pictures(number, output, wanted, pose, now_ns)
        for topic in output.infos:
            if topic in wanted:
                yield self._info(number, topic, now_ns)

    def _pictures(
        self, number: int, output: CameraOutput, wanted: set[str], pose: Pose, now_ns: int
    ) -> Iterable[Sample]:
        """Render an output from a pose in the world and return what is wanted of it."""
        from daidalos.simulation.rendering.camera_renderer import encode

        settings = output.settings
        renderer = self._renderer(number)
        renderer.render(self.instance.physics, pose)
        colored = output.points in wanted
        picture = None
        if output.image in wanted or colored:
            picture = renderer.picture(int(self.random.integers(1 << 30)) if settings.noise.stddev else 0)
        if output.image in wanted and picture is not None:
            yield self._image(output.image, output, encode(picture, settings.encoding), settings.encoding, now_ns)
        if output.depth in wanted or output.points in wanted:
            depth = self._depth(renderer, settings)
            if output.depth in wanted:
                yield self._depth_image(output, depth, now_ns)
            if output.points in wanted:
                yield self._points(number, output, depth, picture, now_ns)
        if output.labels in wanted or output.colored_labels in wanted:
            yield from self._segments(renderer, output, wanted, now_ns)

    def _info(self, number: int, topic: str, now_ns: int) -> CameraInfoSample:
        pinhole = self.outputs[number].settings.pinhole
        return info_of(self.outputs[number], topic, now_ns, "plumb_bob", pinhole.distortion, pinhole.matrix)

    def _check(self, element: Element) -> None:
        """Warn where a pinhole cannot show what a ``<camera>`` asks for."""
        if (angle := element.number_of("horizontal_fov", default=0.0)) > WIDEST:
            self.context.warn(f"{element.where}: <horizontal_fov> is {angle:g}, a pinhole shows {WIDEST:.3g} rad of it")

    def _depth(self, renderer: CameraRenderer, settings: CameraSettings) -> NDArray[np.float32]:
        """Return depths with noise; out-of-range values are marked as in REP 118."""
        noise = settings.depth_noise
        if not (noise.stddev or noise.mean):
            return renderer.depth(settings.depth_near, settings.depth_far)
        depth = renderer.depth()
        depth += self.random.standard_normal(depth.shape, dtype=np.float32) * np.float32(noise.stddev)
        depth += np.float32(noise.mean)
        depth[depth > settings.depth_far] = np.inf
        depth[depth < settings.depth_near] = -np.inf
        return depth

    def _depth_image(self, output: CameraOutput, depth: NDArray[np.float32], now_ns: int) -> ImageSample:
        if output.settings.depth_encoding == "16UC1":
            millimetres = np.where(np.isfinite(depth), depth * np.float32(1000), np.float32(0))
            pixels: NDArray[Any] = np.clip(np.round(millimetres), 0, 65535).astype(np.uint16)
            return self._image(output.depth, output, pixels, "16UC1", now_ns)
        return self._image(output.depth, output, depth, "32FC1", now_ns)

    def _points(
        self,
        number: int,
        output: CameraOutput,
        depth: NDArray[np.float32],
        colors: NDArray[np.uint8] | None,
        now_ns: int,
    ) -> PointCloudSample:
        from daidalos.simulation.rendering.image_effects import points_of

        rays = self._rays.get(number)
        if rays is None:
            x, y, z = np.moveaxis(output.settings.pinhole.rays, -1, 0)
            axes = (z, -x, -y) if output.points_ahead_x else (x, y, z)
            rays = self._rays[number] = np.ascontiguousarray(np.stack(axes, axis=-1))
        points = self._pool.take(rays.shape, np.float32)
        points_of(depth, rays, points)
        frame_id = (output.points_frame_id or output.frame_id) if output.points_ahead_x else output.frame_id
        return PointCloudSample(now_ns, output.points, frame_id, points, colors=colors)

    def _segments(
        self, renderer: CameraRenderer, output: CameraOutput, wanted: set[str], now_ns: int
    ) -> Iterable[ImageSample]:
        """Return labels: the class in all bands, or (panoptic) the instance in two bands and the class in the third.

        Instances are counted within their class from 1, in the order in which they came.
        """
        scene = renderer.view.scene
        classes = renderer.of_parts(scene.labels)
        if output.settings.panoptic:
            counts = _instances(scene.labels, scene.owners)
            instances = renderer.of_parts(counts)
            pixels = np.stack((instances & 0xFF, instances >> 8, classes), axis=-1).astype(np.uint8)
        else:
            pixels = np.repeat(classes.astype(np.uint8)[:, :, None], 3, axis=2)
        if output.labels in wanted:
            yield self._image(output.labels, output, pixels, "rgb8", now_ns)
        if output.colored_labels in wanted:
            key = classes.astype(np.int64) + (256 * instances.astype(np.int64) if output.settings.panoptic else 0)
            yield self._image(output.colored_labels, output, _colors(key), "rgb8", now_ns)

    def _image(self, topic: str, output: CameraOutput, pixels: NDArray[Any], encoding: str, now_ns: int) -> ImageSample:
        return ImageSample(now_ns, topic, output.frame_id, encoding, pixels)

    def _renderer(self, number: int) -> CameraRenderer:
        """Return the renderer of an output; it is imported and created on first use."""
        from daidalos.simulation.rendering.camera_renderer import CameraRenderer, CameraRendererSettings

        if not self._renderers:
            for output in self.outputs:
                s = output.settings
                settings = CameraRendererSettings(s.pinhole, s.near, s.far, s.mask, s.noise)
                self._renderers.append(CameraRenderer(settings))
        return self._renderers[number]


def info_of(
    output: CameraOutput, topic: str, now_ns: int, model: str, distortion: tuple[float, ...], matrix: Array
) -> CameraInfoSample:
    """Return the calibration of an output from its distortion model, coefficients and matrix K (3, 3)."""
    projection = np.zeros((3, 4))
    projection[:, :3] = matrix
    projection[0, 3] = -matrix[0, 0] * output.baseline + output.settings.tx
    projection[1, 3] = output.settings.ty
    return CameraInfoSample(
        stamp_ns=now_ns,
        topic=topic,
        frame_id=output.frame_id,
        width=output.settings.pinhole.width,
        height=output.settings.pinhole.height,
        distortion=distortion,
        matrix=matrix,
        projection=projection,
        distortion_model=model,
    )


def set_noise(output: CameraOutput, stddev: float) -> None:
    """Set the noise by a standard deviation in shares of full brightness."""
    output.settings = replace(output.settings, noise=replace(output.settings.noise, stddev=stddev))


def _instances(labels: NDArray[np.int32], owners: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return for each part its model's number among those of its class, from 1; 0 without a class."""
    counts = np.zeros(len(labels), dtype=np.int32)
    for label in np.unique(labels[labels > 0]):
        here = labels == label
        counts[here] = np.unique(owners[here], return_inverse=True)[1].ravel() + 1
    return counts


def _colors(keys: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Return a colour for each number, black for 0."""
    mixed = (keys.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(40)
    bands = np.stack([(mixed >> np.uint64(shift)) & np.uint64(0xFF) for shift in (0, 8, 16)], axis=-1)
    bright = (np.uint64(55) + bands * np.uint64(200) // np.uint64(255)).astype(np.uint8)
    bright[keys == 0] = 0
    return bright
