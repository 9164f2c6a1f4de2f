"""GPS, magnetometer, altimeter, barometer, sonar, contact and force-torque sensors."""

import math

import numpy as np
import pytest

from daidalos.description import sdf
from daidalos.description.errors import DescriptionError
from daidalos.samples.sensors import (
    AltimeterSample,
    BumperSample,
    ContactsSample,
    MagneticFieldSample,
    NavSatSample,
    PressureSample,
    RangeSample,
    WrenchSample,
)
from daidalos.simulation import Simulation
from simulation.models import box, world

SECOND = 1_000_000_000


def sensor(kind, settings="", pose="0 0 0 0 0 0", rate=100, more=""):
    return (
        f"<sensor name='s' type='{kind}'><pose>{pose}</pose><update_rate>{rate}</update_rate>{settings}{more}</sensor>"
    )


def all_of(simulation, kind, duration=SECOND // 10):
    return [s for s in simulation.advance(duration) if isinstance(s, kind)]


def last(simulation, kind, duration=SECOND // 10):
    return all_of(simulation, kind, duration)[-1]


def noise(tag, stddev, more=""):
    return f"<{tag}><noise type='gaussian'><stddev>{stddev}</stddev>{more}</noise></{tag}>"


PLACE = (
    "<spherical_coordinates><surface_model>EARTH_WGS84</surface_model><latitude_deg>49.9</latitude_deg>"
    "<longitude_deg>8.9</longitude_deg><elevation>143</elevation><heading_deg>0</heading_deg></spherical_coordinates>"
)


def test_a_gps_tells_place_and_speed():
    simulation = Simulation(world(PLACE, box("b", "100 50 0.5 0 0 0", extra=sensor("navsat", "<navsat/>"))))
    sample = last(simulation, NavSatSample)
    assert sample.latitude == pytest.approx(49.9 + math.degrees(50 / 6373000), abs=1e-6)
    assert sample.longitude == pytest.approx(
        8.9 + math.degrees(100 / (6378000 * math.cos(math.radians(49.9)))), abs=5e-6
    )
    assert sample.altitude == pytest.approx(143.5, abs=0.01)
    simulation.set_velocity("b", (0, 0, 5), (0, 0, 0))
    assert last(simulation, NavSatSample, 10_000_000).velocity[2] == pytest.approx(5, abs=0.2)


@pytest.mark.parametrize("heading", [0, 180])
def test_worlds_for_gazebo_classic_mean_no_heading_by_180_degrees(heading):
    plugin = "<gps/><plugin name='p' filename='libgazebo_ros_gps_sensor.so'/>"
    place = PLACE.replace("<heading_deg>0", f"<heading_deg>{heading}")
    sample = last(Simulation(world(place, box("b", "100 50 0.5 0 0 0", extra=sensor("gps", plugin)))), NavSatSample)
    assert sample.longitude > 8.9
    assert sample.latitude > float(PLACE.partition("<latitude_deg>")[2].partition("<")[0])


@pytest.mark.slow
def test_a_gps_has_the_noise_that_was_asked_for():
    settings = (
        "<gps><position_sensing>" + noise("horizontal", 2.0) + noise("vertical", 4.0) + "</position_sensing></gps>"
    )
    simulation = Simulation(world(PLACE, box("b", static=True, extra=sensor("gps", settings))))
    samples = all_of(simulation, NavSatSample, 20 * SECOND)
    assert np.std([s.altitude for s in samples]) == pytest.approx(4.0, rel=0.1)
    assert np.std([math.radians(s.latitude) * 6.37e6 for s in samples]) == pytest.approx(2.0, rel=0.1)
    assert samples[0].covariance[[0, 4, 8]] == pytest.approx([4, 4, 16])


def test_a_magnetometer_turns_with_its_link():
    field = "<magnetic_field>6e-6 0 -4e-5</magnetic_field>"
    extra = sensor("magnetometer")
    simulation = Simulation(world(field, box("b", "0 0 0.5 0 0 1.5707963267948966", static=True, extra=extra)))
    assert last(simulation, MagneticFieldSample).field == pytest.approx([0, -6e-6, -4e-5], abs=1e-12)


def test_an_altimeter_measures_from_where_it_started():
    simulation = Simulation(world(box("b", "0 0 10.5 0 0 0", extra=sensor("altimeter"))))
    sample = last(simulation, AltimeterSample, SECOND)
    assert sample.reference == pytest.approx(10.5)
    assert sample.position == pytest.approx(-0.5 * 9.8, rel=2e-3)
    assert sample.velocity == pytest.approx(-9.8, rel=2e-3)


def test_air_is_thinner_higher_up():
    """International standard atmosphere: 89874.6 Pa at 1000 m."""
    simulation = Simulation(world(box("b", "0 0 1000 0 0 0", static=True, extra=sensor("air_pressure"))))
    assert last(simulation, PressureSample).pressure == pytest.approx(89874.6, abs=2)


SONAR = "<sonar><min>0.1</min><max>3</max><radius>1</radius></sonar>"


@pytest.mark.parametrize(("y", "seen"), [(0.0, True), (1.0, True), (1.6, False)])
def test_a_sonar_sees_what_is_in_its_cone(y, seen):
    eye = box("eye", "0 0 2 0 0 0", "0.1 0.1 0.1", static=True, extra=sensor("sonar", SONAR))
    simulation = Simulation(world(eye, box("thing", f"2.5 {y} 2 0 0 0", "0.5 0.5 0.5", static=True)))
    sample = last(simulation, RangeSample)
    assert sample.field_of_view == pytest.approx(2 * math.atan(1 / 3))
    if seen:
        assert sample.range == pytest.approx(math.hypot(2.25, max(0, abs(y) - 0.25)), abs=0.1)
    else:
        assert sample.range == math.inf


CONTACT = "<contact><collision>shape</collision></contact>"


def test_a_contact_sensor_tells_who_carries_it():
    simulation = Simulation(world(box("b", mass=2.0, extra=sensor("contact", CONTACT))))
    (contact,) = last(simulation, ContactsSample, SECOND).contacts
    assert (contact.model1, contact.link1, contact.collision1) == ("b", "link", "shape")
    assert contact.model2 == "ground_plane"
    # On the second of the pair, the ground: the weight.
    assert contact.forces.sum(axis=0) == pytest.approx([0, 0, -2 * 9.8], abs=0.05)
    assert contact.normals[0] == pytest.approx([0, 0, -1])


def test_a_contact_sensor_is_silent_about_others():
    simulation = Simulation(world(box("b", "0 0 5 0 0 0", extra=sensor("contact", CONTACT)), box("c", "9 0 0.5 0 0 0")))
    assert last(simulation, ContactsSample, SECOND // 5).contacts == ()


def test_a_bumper_has_its_own_topic():
    plugin = (
        "<plugin name='p' filename='libgazebo_ros_bumper.so'><ros><namespace>bot</namespace>"
        "<remapping>bumper_states:=bump</remapping></ros><frame_name>world</frame_name></plugin>"
    )
    simulation = Simulation(world(box("b", extra=sensor("contact", CONTACT, more=plugin))))
    sample = last(simulation, BumperSample)
    assert (sample.topic, sample.frame_id) == ("/bot/bump", "world")


def arm(settings="", where="joint", plugin=""):
    """Return an arm of 1 m that is held at its end, with a weight of 2 kg half way out along x."""
    inertia = "<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia>"
    inside = sensor("force_torque", f"<force_torque>{settings}</force_torque>") if not plugin else ""
    return sdf.parse(
        "<sdf version='1.9'><world name='w'><model name='m'><link name='base'/>"
        f"<link name='arm'><inertial><pose>0.5 0 0 0 0 0</pose><mass>2</mass>{inertia}</inertial></link>"
        "<joint name='fixed' type='fixed'><parent>world</parent><child>base</child></joint>"
        "<joint name='j' type='revolute'><parent>base</parent><child>arm</child><axis><xyz>0 1 0</xyz>"
        f"<limit><lower>0</lower><upper>0</upper></limit></axis>{inside}</joint>{plugin}</model></world></sdf>"
    )


def test_a_joint_carries_weight_and_torque():
    """The child pulls its parent down, and turns it about +y (from x towards -z)."""
    sample = last(Simulation(arm()), WrenchSample, SECOND)
    assert sample.force == pytest.approx([0, 0, -2 * 9.8], abs=0.05)
    assert sample.torque == pytest.approx([0, 2 * 9.8 * 0.5, 0], abs=0.05)


def test_the_other_direction_is_the_opposite():
    sample = last(Simulation(arm("<measure_direction>parent_to_child</measure_direction>")), WrenchSample, SECOND)
    assert sample.force == pytest.approx([0, 0, 2 * 9.8], abs=0.05)


@pytest.mark.parametrize("place", ["<joint_name>j</joint_name>", "<body_name>arm</body_name>"])
def test_the_plugin_of_a_joint_measures_what_the_joint_does_to_its_child(place):
    plugin = (
        f"<plugin name='ft' filename='libgazebo_ros_ft_sensor.so'>{place}"
        "<update_rate>100</update_rate><ros><remapping>wrench:=ft</remapping></ros></plugin>"
    )
    sample = last(Simulation(arm(plugin=plugin)), WrenchSample, SECOND)
    assert (sample.topic, sample.frame_id) == ("/ft", "arm")
    assert sample.force == pytest.approx([0, 0, 2 * 9.8], abs=0.05)


def test_an_unknown_frame_is_named():
    with pytest.raises(DescriptionError, match="'tool', expected one of child, parent, sensor"):
        Simulation(arm("<frame>tool</frame>"))


def test_a_range_plugin_tells_the_nearest_of_all_rays():
    ray = (
        "<ray><scan><horizontal><samples>11</samples><min_angle>-0.2</min_angle><max_angle>0.2</max_angle>"
        "</horizontal></scan><range><min>0.1</min><max>4</max></range></ray>"
    )
    names = "<topicName>near</topicName><frameName>ir</frameName>"
    plugin = f"<plugin name='p' filename='libgazebo_ros_range.so'>{names}</plugin>"
    eye = box("eye", "0 0 2 0 0 0", "0.1 0.1 0.1", static=True, extra=sensor("ray", ray, more=plugin))
    simulation = Simulation(world(eye, box("wall", "2 0 2 0 0 0", static=True)))
    sample = last(simulation, RangeSample)
    assert (sample.topic, sample.frame_id) == ("/near", "ir")
    assert sample.range == pytest.approx(1.5)


def test_biases_come_back_with_a_saved_state():
    bias = "<bias_mean>1</bias_mean><dynamic_bias_stddev>1</dynamic_bias_stddev>"
    bias += "<dynamic_bias_correlation_time>0.5</dynamic_bias_correlation_time>"
    settings = f"<altimeter>{noise('vertical_position', 0.1, bias)}</altimeter>"
    simulation = Simulation(world(box("b", static=True, extra=sensor("altimeter", settings))))
    simulation.advance(SECOND)
    state = simulation.save()
    first = [s.position for s in all_of(simulation, AltimeterSample)]
    simulation.restore(state)
    assert [s.position for s in all_of(simulation, AltimeterSample)] == first
