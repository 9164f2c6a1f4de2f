import math

import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf, urdf
from daidalos.description.errors import DescriptionError
from daidalos.samples.sensors import LaserScanSample, PointCloudSample
from daidalos.simulation import Simulation
from simulation.models import box, world


def carrier(pose="0 0 0.5 0 0 0", scan="", limits="", noise="", mount="0 0 0 0 0 0", kind="ray", body=""):
    """A fixed post with a lidar of 5 rays from -90 to 90 degrees."""
    scan = scan or (
        "<horizontal><samples>5</samples><min_angle>-1.5707963267948966</min_angle>"
        "<max_angle>1.5707963267948966</max_angle></horizontal>"
    )
    limits = limits or "<min>0.1</min><max>8</max>"
    return (
        f"<model name='post'><static>1</static><pose>{pose}</pose><link name='eye'>{body}"
        f"<sensor name='laser' type='{kind}'><pose>{mount}</pose><update_rate>10</update_rate>"
        f"<ray><scan>{scan}</scan><range>{limits}</range>{noise}</ray></sensor></link></model>"
    )


def scan(*parts, seed=0):
    """Return the first scan in a world with a wall 3 m ahead."""
    wall = box("wall", "3.5 0 0.5 0 0 0", "1 20 1", static=True)
    simulation = Simulation(world(wall, *parts), seed=seed)
    return simulation.advance(100_000_000)[0]


def test_a_wall_in_closed_form():
    sample = scan(carrier())
    assert isinstance(sample, LaserScanSample)
    assert sample.stamp_ns == 100_000_000
    assert sample.topic == "/post/eye/laser/scan"
    assert sample.frame_id == "eye"
    assert (sample.angle_min, sample.angle_max) == (-np.pi / 2, np.pi / 2)
    assert sample.angle_increment == pytest.approx(np.pi / 4)
    assert (sample.range_min, sample.range_max, sample.scan_time) == (0.1, 8, 0.1)
    np.testing.assert_allclose(sample.ranges, [np.inf, 3 * np.sqrt(2), 3, 3 * np.sqrt(2), np.inf], rtol=1e-6)
    assert sample.ranges.dtype == np.float32


@pytest.mark.parametrize("kind", ["ray", "lidar", "gpu_ray", "gpu_lidar"])
def test_every_name_of_a_lidar(kind):
    assert scan(carrier(kind=kind)).ranges[2] == pytest.approx(3)


def test_the_mount_turns_and_shifts_the_rays():
    sample = scan(carrier(mount="0.5 0 0 0 0 0.7853981633974483"))
    np.testing.assert_allclose(sample.ranges[1:3], [2.5, 2.5 * np.sqrt(2)], rtol=1e-6)


def test_rays_that_look_down_see_the_ground():
    sample = scan(carrier(mount="0 0 0 0 0.5 0"))
    assert sample.ranges[2] == pytest.approx(0.5 / np.sin(0.5), rel=1e-6)


def test_reach_and_samples_times_resolution():
    sample = scan(carrier(limits="<min>0.1</min><max>3.1</max>"))
    assert np.isfinite(sample.ranges).tolist() == [False, False, True, False, False]
    fan = "<horizontal><samples>820</samples><resolution>0.5</resolution><min_angle>-1</min_angle>"
    assert len(scan(carrier(scan=f"{fan}<max_angle>1</max_angle></horizontal>")).ranges) == 410
    flat = "<vertical><samples>1</samples><resolution>0.01</resolution></vertical>"
    assert len(scan(carrier(scan=f"{fan}<max_angle>1</max_angle></horizontal>{flat}")).ranges) == 410


def test_own_shapes_within_the_least_range_are_passed_and_others_are_too_near():
    shell = "<collision name='c'><geometry><sphere><radius>0.09</radius></sphere></geometry></collision>"
    assert scan(carrier(body=shell)).ranges[2] == pytest.approx(3)
    case = carrier().replace("<link name='eye'>", f"<link name='case'>{shell}</link><link name='eye'>")
    assert scan(case).ranges[2] == pytest.approx(3)
    near = box("near", "0.3 0 0.5 0 0 0", "0.5 0.5 0.5", static=True)
    assert scan(carrier(), near).ranges[2] == -np.inf


def test_own_shapes_beyond_it_are_seen():
    mast = "<link name='mast'><pose>1 0 0 0 0 0</pose><collision name='c'><geometry><sphere><radius>0.1</radius>"
    mast += "</sphere></geometry></collision></link><link name='eye'>"
    assert scan(carrier().replace("<link name='eye'>", mast)).ranges[2] == pytest.approx(0.9)


def test_what_is_no_collision_is_not_seen():
    glass = box("glass", "1 0 0.5 0 0 0", "0.1 9 1", static=True).replace("collision", "visual")
    assert scan(carrier(), glass).ranges[2] == pytest.approx(3)


def test_noise_spreads_what_is_seen_and_stays_in_reach():
    fan = "<horizontal><samples>2001</samples><min_angle>-1.1</min_angle><max_angle>1.1</max_angle>"
    fan += "</horizontal>"
    noise = "<noise><type>gaussian</type><mean>0.01</mean><stddev>0.05</stddev></noise>"
    exact, noisy = scan(carrier(scan=fan)).ranges, scan(carrier(scan=fan, noise=noise)).ranges
    error = (noisy - exact)[exact < 6.7]
    assert error.mean() == pytest.approx(0.01, abs=0.005)
    assert error.std() == pytest.approx(0.05, rel=0.06)
    assert np.isfinite(noisy).all()
    assert noisy.max() <= 8
    assert (scan(carrier(scan=fan, noise=noise), seed=1).ranges != noisy).any()


def test_ranges_are_rounded_to_the_resolution():
    sample = scan(carrier(limits="<min>0.1</min><max>8</max><resolution>0.25</resolution>"))
    np.testing.assert_allclose(sample.ranges[1:4], [4.25, 3, 4.25])


def test_intensities_are_what_surfaces_reflect():
    wall = box("mirror", "2.5 0 0.5 0 0 0", "1 1 1", static=True, surface="<laser_retro>200</laser_retro>")
    sample = scan(carrier(), wall)
    assert sample.intensities.tolist() == [0, 0, 200, 0, 0]


def test_rings_become_points():
    fan = (
        "<horizontal><samples>3</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal>"
        "<vertical><samples>2</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical>"
    )
    sample = scan(carrier(scan=fan))
    assert isinstance(sample, PointCloudSample)
    assert sample.points.shape == (2, 3, 3)
    np.testing.assert_allclose(sample.points[:, :, 0], 3, rtol=1e-5)
    np.testing.assert_allclose(sample.points[:, 1, 2], [-3 * np.tan(0.1), 3 * np.tan(0.1)], rtol=1e-5)


def test_gzs_lidar_speaks_in_ranges_and_in_points():
    fan = (
        "<horizontal><samples>3</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></horizontal>"
        "<vertical><samples>3</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical>"
    )
    samples = Simulation(world(box("wall", "3.5 0 0 0 0 0", "1 9 9", static=True), carrier(scan=fan, kind="gpu_lidar")))
    ranges, points = samples.advance(200_000_000)[-2:]
    assert isinstance(ranges, LaserScanSample)
    assert isinstance(points, PointCloudSample)
    assert points.topic == f"{ranges.topic}/points"
    assert ranges.ranges[1] == pytest.approx(3.0)
    assert points.points.shape == (3, 3, 3)


def test_angles_may_fall():
    fan = (
        "<horizontal><samples>3</samples><min_angle>0.5</min_angle><max_angle>-0.5</max_angle></horizontal>"
        "<vertical><samples>3</samples><min_angle>0.1</min_angle><max_angle>-0.1</max_angle></vertical>"
    )
    points = scan(carrier(scan=fan)).points
    assert points[:, 1, 2] == pytest.approx([3 * math.tan(0.1), 0, -3 * math.tan(0.1)], abs=1e-5)
    assert points[1, :, 1] == pytest.approx([3 * math.tan(0.5), 0, -3 * math.tan(0.5)], abs=1e-5)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("<samples>5", "<samples>0"), "expected 1 to 1000000 rays, got 0"),
        (("<samples>5", "<samples>2.5"), "expected an integer"),
        (("<min>0.1", "<min>9"), "expected 0 <= min < max"),
    ],
)
def test_mistakes(change, words):
    with pytest.raises(DescriptionError, match=words):
        Simulation(world(carrier().replace(*change)))


def lidar_robot(plugin):
    return urdf.parse(
        "<robot name='r'><link name='base_scan'/><gazebo reference='base_scan'>"
        "<sensor name='s' type='ray'><update_rate>10</update_rate><ray><scan><horizontal><samples>3</samples>"
        "</horizontal></scan></ray>"
        f"{plugin}</sensor></gazebo></robot>"
    )


@pytest.mark.parametrize(
    ("plugin", "topic", "frame", "sample"),
    [
        (
            "<plugin name='p' filename='libgazebo_ros_laser.so'><topicName> scan </topicName>"
            "<frameName>/laser</frameName></plugin>",
            "/n/scan",
            "laser",
            LaserScanSample,
        ),
        (
            "<plugin name='p' filename='libgazebo_ros_block_laser.so'><topicName>/cloud</topicName></plugin>",
            "/cloud",
            "base_scan",
            PointCloudSample,
        ),
        (
            "<plugin name='p' filename='libgazebo_ros_ray_sensor.so'>"
            "<ros><namespace>front</namespace><remapping>~/out:=scan</remapping></ros>"
            "<output_type>sensor_msgs/LaserScan</output_type><frame_name>eye</frame_name></plugin>",
            "/n/front/scan",
            "eye",
            LaserScanSample,
        ),
        (
            "<plugin name='p' filename='libgazebo_ros_ray_sensor.so'/>",
            "/n/p/out",
            "base_scan",
            PointCloudSample,
        ),
        ("", "/n/r/base_scan/s/scan", "base_scan", LaserScanSample),
    ],
)
def test_ros_plugins_name_topic_frame_and_message(plugin, topic, frame, sample):
    simulation = Simulation(world())
    simulation.spawn(lidar_robot(plugin), pose=Pose((0, 0, 5)), namespace="n")
    assert simulation.publications == {topic: sample}
    (first,) = simulation.advance(100_000_000)
    assert (first.topic, first.frame_id, type(first)) == (topic, frame, sample)


def test_every_plugin_of_a_sensor_tells_of_the_same_measurement():
    plugins = "".join(
        f"<plugin name='{name}' filename='libgazebo_ros_ray_sensor.so'><ros><remapping>~/out:={name}</remapping></ros>"
        f"<output_type>sensor_msgs/{kind}</output_type></plugin>"
        for name, kind in (("one", "LaserScan"), ("two", "LaserScan"), ("cloud", "PointCloud2"))
    )
    noise = "<noise><type>gaussian</type><stddev>0.1</stddev></noise>"
    wall = box("wall", "3.5 0 0.5 0 0 0", "1 20 1", static=True)
    text = world(wall, carrier(noise=noise).replace("</ray>", f"</ray>{plugins}"))
    simulation = Simulation(text)
    assert simulation.publications == {"/one": LaserScanSample, "/two": LaserScanSample, "/cloud": PointCloudSample}
    one, two, _ = simulation.advance(100_000_000)
    np.testing.assert_array_equal(one.ranges, two.ranges)
    assert one.ranges[2] != pytest.approx(3, abs=1e-4)


def square(half):
    points = ((-half, -half), (half, -half), (half, half), (-half, half))
    return f"<polyline><height>1</height>{''.join(f'<point>{x} {y}</point>' for x, y in points)}</polyline>"


def test_concave_meshes_are_seen_as_they_are():
    """Inside a tub: rays hit its inner walls although it collides in convex parts."""
    tub = sdf.parse(
        "<sdf version='1.9'><world name='w'><model name='tub'><static>1</static><link name='l'>"
        f"<collision name='c'><geometry>{square(2)}{square(1.5)}</geometry></collision></link></model>"
        f"{carrier()}</world></sdf>"
    )
    (sample,) = Simulation(tub).advance(100_000_000)
    np.testing.assert_allclose(sample.ranges, 1.5 * np.array([1, np.sqrt(2), 1, np.sqrt(2), 1]), rtol=1e-5)
