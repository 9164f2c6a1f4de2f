"""Every sample has a message that holds what it says."""

import inspect

import numpy as np
import pytest

from daidalos.nodes.gazebo_ros._messages import INCOMING, OUTGOING, outgoing
from daidalos.samples import commands
from daidalos.samples import sensors as samples
from daidalos.simulation import Simulation
from simulation.models import world


def subclasses(cls):
    return {cls, *(deep for direct in cls.__subclasses__() for deep in subclasses(direct))}


def test_every_kind_of_sample_has_a_message():
    kinds = {cls for cls in subclasses(samples.Sample) if cls.__module__ == samples.__name__} - {samples.Sample}
    assert kinds == set(OUTGOING)


def test_every_kind_of_command_has_a_message():
    kinds = {cls for name, cls in inspect.getmembers(commands, inspect.isclass) if name.endswith("Command")}
    assert kinds == set(INCOMING)


def test_users_may_bring_samples_of_their_own():
    class Smell(samples.Sample):
        pass

    class Colder(samples.TransformSample):
        pass

    class Taste(samples.Sample):
        message_class = staticmethod(lambda: str)

        def to_message(self):
            return "sweet"

    assert outgoing(Smell) is None
    assert outgoing(Colder) is OUTGOING[samples.TransformSample]
    assert outgoing(Taste).convert(Taste(0, "/taste", "")) == "sweet"


def sensor(kind, settings=""):
    return f"<sensor name='{kind}' type='{kind}'><update_rate>100</update_rate>{settings}</sensor>"


IMAGE = "<camera><image><width>8</width><height>6</height></image></camera>"
SENSORS = {
    "ray": "<ray><scan><horizontal><samples>4</samples><min_angle>0</min_angle><max_angle>1</max_angle></horizontal>"
    "</scan></ray>",
    "rgbd_camera": IMAGE,
    "imu": "",
    "navsat": "",
    "magnetometer": "",
    "altimeter": "",
    "air_pressure": "",
    "sonar": "",
    "contact": "",
    "logical_camera": "",
}


@pytest.fixture(scope="module")
def messages():
    sensors = "".join(sensor(kind, settings) for kind, settings in SENSORS.items())
    box = "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
    model = f"<model name='m'><pose>0 0 0.499 0 0 0</pose><link name='l'>{box}{sensors}</link></model>"
    said = Simulation(world(model)).advance(11_000_000)
    return {sample.topic.rpartition("/")[2]: (sample, OUTGOING[type(sample)].convert(sample)) for sample in said}


def test_images_carry_their_bytes(messages):
    sample, message = messages["image"]
    assert (message.width, message.height, message.step, message.encoding) == (8, 6, 24, "rgb8")
    assert bytes(message.data) == sample.pixels.tobytes()
    depth, message = messages["depth_image"]
    assert (message.step, message.encoding) == (32, "32FC1")
    assert np.frombuffer(message.data, np.float32).reshape(6, 8)[5].tolist() == depth.pixels[5].tolist()


def test_calibrations_are_those_of_the_pictures(messages):
    message = messages["camera_info"][1]
    assert (message.width, message.height, message.distortion_model) == (8, 6, "plumb_bob")
    assert message.k[2] == pytest.approx(4.0)
    assert message.p[0] == message.k[0]


def test_points_are_read_back_with_their_colours(messages):
    from sensor_msgs_py import point_cloud2

    sample, message = messages["points"]
    assert (message.height, message.width, message.point_step) == (6, 8, 16)
    points = point_cloud2.read_points(message, field_names=("x", "y", "z", "rgb"), skip_nans=False)
    assert points["x"].reshape(6, 8)[5] == pytest.approx(sample.points[5, :, 0])
    packed = np.ascontiguousarray(points["rgb"]).view(np.uint32).reshape(6, 8)
    assert ((packed >> 16) & 255).tolist() == sample.colors[:, :, 0].tolist()
    assert (packed & 255).tolist() == sample.colors[:, :, 2].tolist()


def test_the_others_hold_the_same_numbers(messages):
    fix, message = messages["navsat"]
    assert (message.latitude, message.altitude) == (fix.latitude, fix.altitude)
    field, message = messages["magnetometer"]
    assert message.magnetic_field.y == field.field[1]
    height, message = messages["altimeter"]
    assert message.vertical_position == height.position
    pressure, message = messages["air_pressure"]
    assert message.fluid_pressure == pressure.pressure
    distance, message = messages["sonar"]
    assert message.max_range == distance.range_max
    contacts, message = messages["contact"]
    assert message.contacts[0].collision1.name == "m::l::c"
    assert len(message.contacts[0].positions) == len(contacts.contacts[0].positions)
