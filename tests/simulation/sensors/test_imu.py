import numpy as np
import pytest

from daidalos.description import sdf
from daidalos.samples.sensors import ImuSample
from daidalos.simulation import Simulation
from simulation.models import box, turtlebot, world

SECOND = 1_000_000_000


def imu(pose="0 0 0 0 0 0", settings="", rate=100):
    return (
        f"<sensor name='imu' type='imu'><pose>{pose}</pose><update_rate>{rate}</update_rate>"
        f"<imu>{settings}</imu></sensor>"
    )


def last(simulation, duration=SECOND):
    return [s for s in simulation.advance(duration) if isinstance(s, ImuSample)][-1]


def weightless(*parts):
    return sdf.parse(f"<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity>{''.join(parts)}</world></sdf>")


def test_at_rest_it_feels_the_ground_push_up():
    simulation = Simulation(world(box("b", extra=imu())))
    sample = last(simulation)
    assert sample.linear_acceleration == pytest.approx([0, 0, 9.8], abs=1e-3)
    assert sample.angular_velocity == pytest.approx([0, 0, 0], abs=1e-6)
    assert sample.orientation == pytest.approx([0, 0, 0, 1], abs=1e-4)
    assert (sample.topic, sample.frame_id) == ("/b/link/imu/imu", "link")


def test_in_free_fall_it_feels_nothing():
    simulation = Simulation(world(box("b", "0 0 50 0.3 0.2 0.1", extra=imu("0.1 0 0 0 0 0"))))
    assert last(simulation).linear_acceleration == pytest.approx([0, 0, 0], abs=1e-6)


def test_a_turned_sensor_measures_in_its_own_axes():
    """It looks up with its x axis, so that gravity is felt along x."""
    simulation = Simulation(world(box("b", extra=imu("0 0 0 0 -1.5707963267948966 0"))))
    sample = last(simulation)
    assert sample.linear_acceleration == pytest.approx([9.8, 0, 0], abs=1e-3)
    assert sample.orientation == pytest.approx([0, -np.sqrt(0.5), 0, np.sqrt(0.5)], abs=1e-4)


def test_off_centre_it_feels_the_centripetal_acceleration():
    simulation = Simulation(weightless(box("b", "0 0 0 0 0 0.5", extra=imu("0.3 0 0 0 0 0"))))
    simulation.set_velocity("b", (1, 0, 0), (0, 0, 2.0))
    sample = last(simulation, SECOND // 100)
    assert sample.angular_velocity == pytest.approx([0, 0, 2], abs=1e-9)
    assert sample.linear_acceleration == pytest.approx([-4 * 0.3, 0, 0], abs=1e-6)


def test_the_centre_of_mass_need_not_be_the_links_origin():
    """A stick that spins freely about its middle, with the link at its end."""
    text = box("b", "0 0 0 0 0 0", extra=imu()).replace("<mass>", "<pose>-1 0 0 0 0 0</pose><mass>")
    simulation = Simulation(weightless(text))
    simulation.set_velocity("b", (0, 2.0, 0), (0, 0, 2.0))
    sample = last(simulation, SECOND // 100)
    assert sample.linear_acceleration == pytest.approx([-4, 0, 0], abs=1e-6)


def test_noise_of_each_axis():
    axis = "<{0}><noise type='gaussian'><stddev>{1}</stddev></noise></{0}>"
    settings = (
        f"<angular_velocity>{axis.format('x', 0.1)}{axis.format('z', 0.3)}</angular_velocity>"
        "<linear_acceleration><z><noise type='gaussian'><bias_mean>0.5</bias_mean></noise></z>"
        "</linear_acceleration>"
    )
    simulation = Simulation(weightless(box("b", extra=imu(settings=settings, rate=1000))))
    samples = simulation.advance(2 * SECOND)
    rates = np.array([s.angular_velocity for s in samples])
    assert rates.std(axis=0) == pytest.approx([0.1, 0, 0.3], rel=0.06)
    forces = np.array([s.linear_acceleration for s in samples])
    assert np.abs(forces[:, 2]) == pytest.approx(0.5 * np.ones(2000))
    assert samples[0].angular_velocity_covariance.reshape(3, 3)[2, 2] == pytest.approx(0.09)


def test_the_turtlebots_imu_has_the_courses_noise():
    simulation = Simulation(world(), seed=2)
    simulation.spawn(turtlebot(), "robot")
    simulation.advance(SECOND)
    samples = [s for s in simulation.advance(5 * SECOND) if isinstance(s, ImuSample)]
    assert (len(samples), samples[0].topic, samples[0].frame_id) == (1000, "/imu", "imu_link")
    assert np.array([s.angular_velocity for s in samples]).std(axis=0) == pytest.approx([2e-4] * 3, rel=0.1)
    forces = np.array([s.linear_acceleration for s in samples])
    assert forces.std(axis=0) == pytest.approx([1.7e-2] * 3, rel=0.1)
    tilt = 9.8 * np.sin(simulation.pose("robot", "imu_link").rpy[1])
    assert np.abs(forces.mean(axis=0) - [-tilt, 0, 9.8]) == pytest.approx([0.1] * 3, abs=0.01)


def test_orientation_can_be_left_out():
    simulation = Simulation(world(box("b", extra=imu(settings="<enable_orientation>0</enable_orientation>"))))
    assert last(simulation).orientation_covariance[0] == -1
