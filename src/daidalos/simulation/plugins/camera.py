"""Gazebo classic's camera plugins: topics, frames and limits of a camera sensor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from daidalos.description.markup import Element
from daidalos.samples.commands import SignalCommand
from daidalos.simulation.contracts import Sensor, SensorPlugin
from daidalos.simulation.plugin_parameters import PluginParameters
from daidalos.simulation.sensors.camera import Camera, CameraOutput
from daidalos.simulation.topics import frame


class CameraOfSensor(SensorPlugin):
    """``libgazebo_ros_camera.so`` of ROS 1 and 2, with its variants for depth and multi-camera sensors."""

    names = (
        *("gazebo_ros_camera", "gazebo_ros_triggered_camera", "gazebo_ros_prosilica"),
        *("gazebo_ros_depth_camera", "gazebo_ros_openni_kinect"),
        *("gazebo_ros_multicamera", "gazebo_ros_triggered_multicamera"),
    )
    unused = (
        *("CxPrime", "Cx", "Cy", "focalLength", "autoDistortion", "auto_distortion", "borderCrop", "border_crop"),
        "pollServiceName",
    )

    def configure(self, sensor: Sensor) -> None:
        """Set topics, frame, distortion, baseline and depth limits."""
        parameters, element = self.parameters, self.parameters.element
        if not isinstance(sensor, Camera):
            sensor.context.warn(f"{element.where}: plugin {parameters.library} needs a camera, left out")
            return
        rate = element.number_of("updateRate", "update_rate", default=0.0)
        if rate > 0:
            sensor.period = 1.0 / rate
        ros1 = any(child.tag in _ROS1 for child in element)
        name = element.text_of("cameraName", "camera_name", default="" if ros1 else sensor.name)
        frame_id = frame(element.text_of("frameName", "frame_name", default=sensor.frame_id))
        for output in sensor.outputs:
            prefixes = [name, output.settings.name] if len(sensor.outputs) > 1 else [name]
            output.frame_id, output.points_ahead_x = frame_id, False
            _set_topics(output, prefixes, parameters, deep=sensor.kind in ("depth", "rgbd"))
            _set_optics(output, element)
            # Of several eyes the first is the one that the others' distances are told from.
            if output is not sensor.outputs[0] or len(sensor.outputs) == 1:
                output.baseline = element.number_of("hackBaseline", "hack_baseline", default=0.0) or output.baseline
        if element.flag_of("triggered", default="triggered" in parameters.library):
            topic = element.text_of("triggerTopicName", default="image_trigger")
            sensor.trigger = parameters.topic(_remapped(parameters, [name], topic)), SignalCommand


_ROS1 = ("imageTopicName", "cameraInfoTopicName", "cameraName", "frameName", "depthImageTopicName")


def _set_topics(output: CameraOutput, prefixes: Sequence[str], parameters: PluginParameters, deep: bool) -> None:
    element = parameters.element

    def topic(default: str, *tags: str) -> str:
        name = element.text_of(*tags, default=default) if tags else default
        return parameters.topic(_remapped(parameters, prefixes, name))

    output.image = topic("image_raw", "imageTopicName")
    infos = [topic("camera_info", "cameraInfoTopicName")]
    if deep:
        output.depth = topic("depth/image_raw", "depthImageTopicName")
        output.points = topic("points", "pointCloudTopicName")
        infos.append(topic("depth/camera_info", "depthImageCameraInfoTopicName", "depthImageInfoTopicName"))
    output.infos = tuple(dict.fromkeys(infos))


def _remapped(parameters: PluginParameters, prefixes: Sequence[str], name: str) -> str:
    """Return the name below the camera's, unless a remapping refers to the bare name."""
    full = name if name.startswith("/") else "/".join([*filter(None, prefixes), name])
    return full if parameters.is_remapped(full) or not parameters.is_remapped(name) else name


def _set_optics(output: CameraOutput, element: Element) -> None:
    settings = output.settings
    bent = tuple(
        element.number_of(f"distortion{key.upper()}", f"distortion_{key}", default=value)
        for key, value in zip(("k1", "k2", "t1", "t2", "k3"), settings.pinhole.distortion, strict=True)
    )
    near = element.number_of("pointCloudCutoff", "min_depth", default=settings.depth_near)
    far = element.number_of("pointCloudCutoffMax", "max_depth", default=settings.depth_far)
    if not 0 <= near < far:
        raise element.error(f"expected 0 <= min_depth < max_depth, got {near:g} and {far:g}")
    k1, k2, p1, p2, k3 = bent
    output.settings = replace(
        settings,
        pinhole=replace(settings.pinhole, distortion=(k1, k2, p1, p2, k3)),
        depth_near=near,
        depth_far=far,
        depth_encoding="16UC1" if element.flag_of("useDepth16UC1Format", default=False) else settings.depth_encoding,
    )
