"""Every sample and command has a message that holds what it says."""

import dataclasses
import inspect

import numpy as np
import pytest
from geometry_msgs.msg import TwistStamped, Vector3
from sensor_msgs.msg import BatteryState, NavSatFix, Range

from daidalos.samples import commands, controllers, sensors
from daidalos.samples.controllers import TrajectoryPoint, VelocityCommand
from daidalos.samples.conversion import Conversion
from daidalos.samples.messages import MESSAGES, conversion_of
from daidalos.simulation import Simulation
from simulation.models import world


def classes(module, base=object):
    found = (cls for _, cls in inspect.getmembers(module, inspect.isclass) if cls.__module__ == module.__name__)
    return {cls for cls in found if issubclass(cls, base)} - {base}


def test_every_kind_of_sample_and_command_has_a_message():
    kinds = classes(sensors, sensors.Sample) | classes(controllers, sensors.Sample) | classes(commands)
    kinds |= {cls for cls in classes(controllers) if cls.__name__.endswith("Command")} | {TrajectoryPoint}
    assert kinds == set(MESSAGES)


def _by_names(conversion):
    functions = {"to_message", "from_message"} & set(vars(conversion))
    return not functions and not any(map(callable, conversion.sources.values()))


@pytest.mark.parametrize("kind", [kind for kind in MESSAGES if _by_names(MESSAGES[kind])])
def test_every_field_of_a_sample_is_in_its_message(kind):
    conversion = MESSAGES[kind]
    fields = {field.name for field in dataclasses.fields(kind)} - {"topic", "stamp_ns", "frame_id"}
    taken = {*conversion.sources.values(), *(name for name, *_ in conversion.message_class._FIELDS)}
    assert fields <= taken


def test_a_source_for_a_field_that_the_message_lacks_is_refused():
    with pytest.raises(TypeError, match="Bool has no field 'datum'"):
        Conversion(commands.FlagCommand, "std_msgs/Bool", {"datum": "value"}).to_message(commands.FlagCommand())


def test_messages_are_read_by_names():
    message = TwistStamped()
    message.header.stamp.sec = 3
    message.twist.linear = Vector3(x=1.0, y=2.0, z=3.0)
    command = MESSAGES[VelocityCommand].from_message(message)
    assert command.stamp_ns == 3_000_000_000
    assert command.linear.tolist() == [1.0, 2.0, 3.0]
    assert command.angular.tolist() == [0.0, 0.0, 0.0]


def test_constants_are_those_of_the_messages():
    cone = sensors.RangeSample(0, "/range", "", 0.1, 0.0, 1.0, 0.5, ultrasound=True)
    assert _message(cone).radiation_type == Range.ULTRASOUND
    assert _message(dataclasses.replace(cone, ultrasound=False)).radiation_type == Range.INFRARED
    battery = sensors.BatterySample(0, "/battery", "", 12.0, -1.0, 1.0, 2.0)
    assert _message(battery).power_supply_status == BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    charging = _message(dataclasses.replace(battery, current=1.0))
    assert charging.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    fix = sensors.NavSatSample(0, "/fix", "", 1.0, 2.0, 3.0, np.zeros(3), np.zeros(9))
    assert _message(fix).position_covariance_type == NavSatFix.COVARIANCE_TYPE_UNKNOWN
    known = _message(dataclasses.replace(fix, covariance=np.eye(3).ravel()))
    assert known.position_covariance_type == NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN


def _message(sample):
    return MESSAGES[type(sample)].to_message(sample)


def test_users_may_bring_samples_of_their_own():
    class Smell(sensors.Sample):
        pass

    class Colder(sensors.TransformSample):
        pass

    class Taste(sensors.Sample):
        message_class = staticmethod(lambda: str)

        def to_message(self):
            return "sweet"

    assert conversion_of(Smell) is None
    assert conversion_of(Colder) is MESSAGES[sensors.TransformSample]
    assert conversion_of(Taste).to_message(Taste(0, "/taste", "")) == "sweet"
    assert conversion_of(Taste).message_class is str


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
    described = "".join(sensor(kind, settings) for kind, settings in SENSORS.items())
    box = "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
    model = f"<model name='m'><pose>0 0 0.499 0 0 0</pose><link name='l'>{box}{described}</link></model>"
    said = Simulation(world(model)).advance(11_000_000)
    return {sample.topic.rpartition("/")[2]: (sample, _message(sample)) for sample in said}


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
