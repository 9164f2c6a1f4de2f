"""Laser scans as point clouds."""

import math

import pytest
from builtin_interfaces.msg import Time
from hypothesis import given
from hypothesis import strategies as st
from laser_geometry import LaserProjection
from sensor_msgs.msg import LaserScan, PointField
from sensor_msgs_py.point_cloud2 import read_points
from std_msgs.msg import Header

OPTIONS = LaserProjection.ChannelOption
ALL = OPTIONS.INTENSITY | OPTIONS.INDEX | OPTIONS.DISTANCE | OPTIONS.TIMESTAMP | OPTIONS.VIEWPOINT


def scan(ranges, intensities=None, **changes):
    return LaserScan(
        header=Header(stamp=Time(sec=5, nanosec=7), frame_id="laser"),
        **{"angle_min": -math.pi / 2, "angle_increment": math.pi / 4, "time_increment": 0.01} | changes,
        range_min=0.5,
        range_max=10.0,
        ranges=ranges,
        intensities=[] if intensities is None else intensities,
    )


@given(
    ranges=st.lists(st.floats(0.0, 12.0, width=32) | st.sampled_from([math.nan, math.inf, -math.inf]), max_size=30),
    start=st.floats(-4.0, 4.0, width=32),
    step=st.floats(-0.5, 0.5, width=32),
    cutoff=st.sampled_from([-1.0, 0.7, 3.0, 20.0]),
)
def test_every_good_measurement_is_a_point(ranges, start, step, cutoff):
    message = scan(ranges, ranges, angle_min=start, angle_increment=step)
    cloud = LaserProjection().projectLaser(message, cutoff, ALL)
    far = 10.0 if cutoff < 0 else min(cutoff, 10.0)
    good = [(index, value) for index, value in enumerate(message.ranges) if 0.5 <= value < far]
    points = read_points(cloud)
    assert len(points) == len(good) == cloud.width
    for (index, value), point in zip(good, points, strict=True):
        angle = start + index * step
        assert point["x"] == pytest.approx(value * math.cos(angle), abs=1e-5)
        assert point["y"] == pytest.approx(value * math.sin(angle), abs=1e-5)
        assert point["stamps"] == pytest.approx(0.01 * index)
        assert (point["z"], point["index"], point["distances"], point["intensity"]) == (0.0, index, value, value)
        assert (point["vp_x"], point["vp_y"], point["vp_z"]) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("options", "names"),
    [
        (OPTIONS.DEFAULT, ["x", "y", "z", "intensity", "index"]),
        (OPTIONS.NONE, ["x", "y", "z"]),
        (OPTIONS.DISTANCE | OPTIONS.TIMESTAMP, ["x", "y", "z", "distances", "stamps"]),
        (ALL, ["x", "y", "z", "intensity", "index", "distances", "stamps", "vp_x", "vp_y", "vp_z"]),
    ],
)
def test_the_channels_that_were_asked_for(options, names):
    cloud = LaserProjection().projectLaser(scan([1.0, 2.0], [7.0, 8.0]), channel_options=options)
    assert [field.name for field in cloud.fields] == names
    assert [field.offset for field in cloud.fields] == [4 * place for place in range(len(names))]
    kinds = {field.name: field.datatype for field in cloud.fields}
    assert kinds.pop("index", PointField.INT32) == PointField.INT32
    assert set(kinds.values()) == {PointField.FLOAT32}
    assert (cloud.header.frame_id, cloud.header.stamp, cloud.height) == ("laser", Time(sec=5, nanosec=7), 1)


def test_a_scan_without_intensities_has_none():
    cloud = LaserProjection().projectLaser(scan([1.0, 2.0]))
    assert [field.name for field in cloud.fields] == ["x", "y", "z", "index"]


def test_one_projection_takes_different_scans():
    projection = LaserProjection()
    for start in (0.0, math.pi / 2, 0.0):
        point = read_points(projection.projectLaser(scan([2.0], angle_min=start)))[0]
        assert (point["x"], point["y"]) == pytest.approx((2 * math.cos(start), 2 * math.sin(start)), abs=1e-6)
