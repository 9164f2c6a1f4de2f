"""Cameras: colour, depth, both, several eyes, and labels instead of colours."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daidalos.description.link import Sensor as Description
from daidalos.description.markup import Element
from daidalos.simulation.component import ComponentContext, Subscription
from daidalos.simulation.rendering.pool import Pool
from daidalos.simulation.samples import (
    CameraInfoSample,
    FlagCommand,
    ImageSample,
    PointCloudSample,
    Sample,
    SignalCommand,
)
from daidalos.simulation.sensors.base import Sensor
from daidalos.simulation.sensors.camera_settings import CameraSettings, read_camera
from daidalos.simulation.topics import absolute_topic

if TYPE_CHECKING:
    from daidalos.simulation.rendering.eye import Eye


@dataclass
class Lens:
    """One eye of a camera sensor and where it publishes; a plugin may change it before it is used.

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
        Distance to the left eye of a stereo pair [m]; goes into the projection matrix.
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
        """Return what is published where."""
        pictures = (self.image, self.depth, self.labels, self.colored_labels)
        topics: dict[str, type[Sample]] = dict.fromkeys(pictures, ImageSample)
        topics |= {self.points: PointCloudSample}
        topics |= dict.fromkeys(self.infos, CameraInfoSample)
        return {topic: kind for topic, kind in topics.items() if topic}


@dataclass
class Trigger:
    """Whether a camera was told to look."""

    due: bool = False


class Camera(Sensor):
    """A camera of one or several eyes, drawn by the software renderer.

    Attributes
    ----------
    lenses : list of Lens
    trigger : tuple of (str, type) or None
        The topic, and the class of its commands, that makes it look; None where it looks by itself.
    """

    state: Trigger

    names = (
        *("camera", "depth", "depth_camera", "rgbd", "rgbd_camera", "multicamera"),
        *("segmentation", "segmentation_camera", "wideanglecamera"),
    )
    default_topic = "image"

    def __init__(self, description: Description, link: str, context: ComponentContext, joint: str = "") -> None:
        self.kind = description.type.removesuffix("_camera")
        super().__init__(description, link, context, joint)
        if self.kind == "wideanglecamera":
            context.warn(f"{description.element.where}: sensor {self.name!r}: its lens is drawn as a pinhole")
        elements = description.element.all("camera") or [Element("camera")]
        self.lenses = [self._lens(element, several=len(elements) > 1) for element in elements]
        for lens in self.lenses[1:]:
            # To the right of the first eye, as a stereo pair's projection matrices tell it.
            lens.baseline = -(self.lenses[0].settings.pose.inverse @ lens.settings.pose).position[1]
        self._eyes: list[Eye] = []
        first = self.lenses[0].settings
        trigger = absolute_topic(first.trigger_topic or f"{self.topic}/trigger", context.namespace)
        self.trigger: tuple[str, type] | None = (trigger, FlagCommand) if first.triggered else None

    @property
    def publications(self) -> Mapping[str, type[Sample]]:
        """Images, calibrations and points of all eyes."""
        return {topic: kind for lens in self.lenses for topic, kind in lens.topics().items()}

    @property
    def subscriptions(self) -> Mapping[str, Subscription]:
        """What makes it look, where it does not look by itself."""
        return {self.trigger[0]: Subscription(self.trigger[1], self._pull_trigger)} if self.trigger else {}

    def _pull_trigger(self, command: FlagCommand | SignalCommand) -> None:
        self.state.due = isinstance(command, SignalCommand) or command.value

    def start(self) -> Trigger:
        """Make the eyes anew, so that a plugin may have changed their settings."""
        self._eyes = []
        self._pool = Pool()
        self._rays: dict[int, NDArray[np.float32]] = {}
        return Trigger()

    def update(self, now_ns: int) -> Iterable[Sample]:
        """Look with the eyes that somebody listens to."""
        if self.trigger and not self.state.due:
            return
        self.state.due = False
        has_subscribers = self.instance.has_subscribers
        for number, lens in enumerate(self.lenses):
            wanted = {topic for topic in lens.topics() if has_subscribers(topic)}
            if wanted:
                yield from self._look(number, lens, wanted, now_ns)

    def _lens(self, element: Element, several: bool) -> Lens:
        """Read an eye and give it the topics that gz would."""
        settings = read_camera(element)
        lens = Lens(settings, settings.optical_frame or self.frame_id, self.frame_id, points_ahead_x=True)
        description_topic = settings.topic or self.topic
        base = absolute_topic(description_topic, self.context.namespace)
        stem = base.removesuffix("/image") if base == self.topic else base
        if several:
            stem = f"{stem}/{settings.name}"
            base = f"{stem}/image"
        folder = base.rpartition("/")[0]
        info = settings.info_topic or f"{folder}/camera_info"
        if self.kind == "depth":
            lens.depth = f"{stem}/depth_image" if base.endswith("/image") else base
            lens.points = f"{lens.depth}/points"
        elif self.kind == "rgbd":
            lens.image, lens.depth, lens.points = f"{stem}/image", f"{stem}/depth_image", f"{stem}/points"
            info = settings.info_topic or f"{stem}/camera_info"
        elif self.kind == "segmentation":
            lens.labels, lens.colored_labels = f"{stem}/labels_map", f"{stem}/colored_map"
            info = settings.info_topic or f"{stem}/camera_info"
        else:
            lens.image = base
        lens.infos = (absolute_topic(info, self.context.namespace),)
        return lens

    def _look(self, number: int, lens: Lens, wanted: set[str], now_ns: int) -> Iterable[Sample]:
        settings = lens.settings
        seen = wanted - set(lens.infos)
        if seen:
            eye = self._eye(number)
            eye.look(self.instance.physics, self.link.pose @ self.pose @ settings.pose)
            yield from self._pictures(eye, number, lens, wanted, now_ns)
        for topic in lens.infos:
            if topic in wanted:
                yield _info(lens, topic, now_ns)

    def _pictures(self, eye: Eye, number: int, lens: Lens, wanted: set[str], now_ns: int) -> Iterable[Sample]:
        from daidalos.simulation.rendering.eye import encode

        settings = lens.settings
        colored = lens.points in wanted
        picture = None
        if lens.image in wanted or colored:
            picture = eye.picture(int(self.random.integers(1 << 30)) if settings.noise.stddev else 0)
        if lens.image in wanted and picture is not None:
            yield self._image(lens.image, lens, encode(picture, settings.encoding), settings.encoding, now_ns)
        if lens.depth in wanted or lens.points in wanted:
            depth = self._depth(eye, settings)
            if lens.depth in wanted:
                yield self._depth_image(lens, depth, now_ns)
            if lens.points in wanted:
                yield self._points(number, lens, depth, picture, now_ns)
        if lens.labels in wanted or lens.colored_labels in wanted:
            yield from self._segments(eye, lens, wanted, now_ns)

    def _depth(self, eye: Eye, settings: CameraSettings) -> NDArray[np.float32]:
        """Return depths with noise; what is too near or too far is marked (REP 118)."""
        noise = settings.depth_noise
        if not (noise.stddev or noise.mean):
            return eye.depth(settings.depth_near, settings.depth_far)
        depth = eye.depth()
        depth += self.random.standard_normal(depth.shape, dtype=np.float32) * np.float32(noise.stddev)
        depth += np.float32(noise.mean)
        depth[depth > settings.depth_far] = np.inf
        depth[depth < settings.depth_near] = -np.inf
        return depth

    def _depth_image(self, lens: Lens, depth: NDArray[np.float32], now_ns: int) -> ImageSample:
        if lens.settings.depth_encoding == "16UC1":
            millimetres = np.where(np.isfinite(depth), depth * np.float32(1000), np.float32(0))
            pixels: NDArray[Any] = np.clip(np.round(millimetres), 0, 65535).astype(np.uint16)
            return self._image(lens.depth, lens, pixels, "16UC1", now_ns)
        return self._image(lens.depth, lens, depth, "32FC1", now_ns)

    def _points(
        self, number: int, lens: Lens, depth: NDArray[np.float32], colors: NDArray[np.uint8] | None, now_ns: int
    ) -> PointCloudSample:
        from daidalos.simulation.rendering.film import points_of

        rays = self._rays.get(number)
        if rays is None:
            x, y, z = np.moveaxis(lens.settings.pinhole.rays, -1, 0)
            axes = (z, -x, -y) if lens.points_ahead_x else (x, y, z)
            rays = self._rays[number] = np.ascontiguousarray(np.stack(axes, axis=-1))
        points = self._pool.take(rays.shape, np.float32)
        points_of(depth, rays, points)
        frame_id = (lens.points_frame_id or lens.frame_id) if lens.points_ahead_x else lens.frame_id
        return PointCloudSample(now_ns, lens.points, frame_id, points, colors=colors)

    def _segments(self, eye: Eye, lens: Lens, wanted: set[str], now_ns: int) -> Iterable[ImageSample]:
        """Label pixels: the class in all bands, or (panoptic) the instance in the first two and the class in the third.

        Instances are counted within their class from 1, in the order in which they came.
        """
        scene = eye.view.scene
        classes = eye.of_parts(scene.labels)
        if lens.settings.panoptic:
            counts = _instances(scene.labels, scene.owners)
            instances = eye.of_parts(counts)
            pixels = np.stack((instances & 0xFF, instances >> 8, classes), axis=-1).astype(np.uint8)
        else:
            pixels = np.repeat(classes.astype(np.uint8)[:, :, None], 3, axis=2)
        if lens.labels in wanted:
            yield self._image(lens.labels, lens, pixels, "rgb8", now_ns)
        if lens.colored_labels in wanted:
            key = classes.astype(np.int64) + (256 * instances.astype(np.int64) if lens.settings.panoptic else 0)
            yield self._image(lens.colored_labels, lens, _colors(key), "rgb8", now_ns)

    def _image(self, topic: str, lens: Lens, pixels: NDArray[Any], encoding: str, now_ns: int) -> ImageSample:
        return ImageSample(now_ns, topic, lens.frame_id, encoding, pixels)

    def _eye(self, number: int) -> Eye:
        """Return an eye; the renderer is imported and made when it is first needed."""
        from daidalos.simulation.rendering.eye import Eye, EyeSettings

        if not self._eyes:
            for lens in self.lenses:
                s = lens.settings
                eye = EyeSettings(s.pinhole, s.near, s.far, s.mask, s.noise)
                self._eyes.append(Eye(eye, self.context.stream()))
        return self._eyes[number]


def set_noise(lens: Lens, stddev: float) -> None:
    """Give an eye noise of a standard deviation in shares of full brightness."""
    lens.settings = replace(lens.settings, noise=replace(lens.settings.noise, stddev=stddev))


def _info(lens: Lens, topic: str, now_ns: int) -> CameraInfoSample:
    pinhole = lens.settings.pinhole
    projection = np.zeros((3, 4))
    projection[:, :3] = pinhole.matrix
    projection[0, 3] = -pinhole.fx * lens.baseline + lens.settings.tx
    projection[1, 3] = lens.settings.ty
    return CameraInfoSample(
        stamp_ns=now_ns,
        topic=topic,
        frame_id=lens.frame_id,
        width=pinhole.width,
        height=pinhole.height,
        distortion=pinhole.distortion,
        matrix=pinhole.matrix,
        projection=projection,
    )


def _instances(labels: NDArray[np.int32], owners: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return for each part the number of its model among those of its class, from 1; 0 for what has no class."""
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
