import re

import pytest

from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.simulation import Simulation, registry
from daidalos.simulation.plugins.base import Plugin, library_name
from daidalos.simulation.plugins.diff_drive import DiffDrive
from daidalos.simulation.samples import TransformSample
from daidalos.simulation.sensors.base import Sensor
from daidalos.simulation.sensors.lidar import Lidar
from places import REPOSITORY
from simulation.models import box, world


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("libgazebo_ros_imu.so", "gazebo_ros_imu"),
        (" gazebo_ros_imu ", "gazebo_ros_imu"),
        ("/opt/lib/libgazebo_ros_imu.so", "gazebo_ros_imu"),
        ("gz-sim-diff-drive-system", "gz-sim-diff-drive-system"),
        ("gz-sim8-diff-drive-system", "gz-sim-diff-drive-system"),
        ("libignition-gazebo6-diff-drive-system.so", "gz-sim-diff-drive-system"),
        ("ignition-gazebo-diff-drive-system", "gz-sim-diff-drive-system"),
        ("ignition::gazebo::systems::DiffDrive", "gz-sim-diff-drive-system"),
        ("static://gz::sim::systems::NavSat", "gz-sim-nav-sat-system"),
    ],
)
def test_libraries_by_any_of_their_names(written, name):
    assert library_name(written) == name


def written(name, filename):
    return Description(name, filename, Element("plugin"))


def test_ours_are_found():
    assert registry.sensor_class("gpu_lidar") is Lidar
    assert registry.plugin_class(written("p", "libgazebo_ros_diff_drive.so")) is DiffDrive
    assert registry.plugin_class(written("ignition::gazebo::v6::systems::DiffDrive", "gz-sim-systems")) is DiffDrive
    assert registry.plugin_class(written("diff_drive", "libnothing.so")) is None
    assert registry.is_built_in(written("ignition::gazebo::systems::v0::Physics", "libignition-gazebo-systems.so"))
    assert registry.sensor_class("nose") is None


class Greeter(Plugin):
    period = 0.5

    def update(self, now_ns):
        self.state = (self.state or 0) + 1
        yield TransformSample(now_ns, "/hello", "a", "b", (self.state, 0, 0), (0, 0, 0, 1))


class Nose(Sensor):
    types = ("nose",)

    def measure(self, now_ns):
        yield TransformSample(now_ns, self.topic, self.frame_id, "smell", (0, 0, 0), (0, 0, 0, 1))


class Entry:
    def __init__(self, name, target):
        self.name = name
        self.load = lambda: target


def documented_plugin():
    """The class that the documentation shows."""
    page = (REPOSITORY / "docs" / "simulation.md").read_text()
    names = {}
    exec(re.search(r"```python\n(.*?)```", page, re.DOTALL)[1], names)
    return names["Wind"]


@pytest.fixture
def entries(monkeypatch):
    plugins = [Entry("greeter", Greeter), Entry("my_wind", documented_plugin())]
    groups = {"daidalos.plugins": plugins, "daidalos.sensors": [Entry("nose", Nose)]}
    monkeypatch.setattr(registry, "entry_points", lambda group: groups[group])
    registry._plugins.cache_clear()
    registry._sensors.cache_clear()
    yield
    registry._plugins.cache_clear()
    registry._sensors.cache_clear()


@pytest.mark.usefixtures("entries")
def test_the_users_own_come_by_entry_point():
    text = box("b", extra="<sensor name='s' type='nose'><update_rate>1</update_rate></sensor>")
    text = text.replace("</model>", "<plugin name='g' filename='libgreeter.so'/></model>")
    simulation = Simulation(world(text))
    samples = simulation.advance(1_000_000_000)
    assert [(s.stamp_ns, s.topic) for s in samples] == [
        (500_000_000, "/hello"),
        (1_000_000_000, "/hello"),
        (1_000_000_000, "/b/link/s/data"),
    ]
    assert samples[1].translation[0] == 2
    assert not simulation.warnings


def test_the_documented_plugins_are_there():
    rows = [
        line.split("|") for line in (REPOSITORY / "docs/simulation.md").read_text().splitlines() if line.count("|") == 4
    ]
    plugins = rows[next(i for i, row in enumerate(rows) if "gz-sim-...-system" in row[3]) + 2 :]
    names = [
        *(
            name if "libgazebo" in name else f"libgazebo_ros_{name}"
            for row in plugins
            for name in re.findall("`(.*?)`", row[2])
        ),
        *(
            name if "-system" in name else f"gz-sim-{name}-system"
            for row in plugins
            for name in re.findall("`(.*?)`", row[3])
        ),
    ]
    assert len(names) > 40
    for name in names:
        assert registry.plugin_class(written("p", name)) or registry.is_built_in(written("p", name)), name


@pytest.mark.usefixtures("entries")
def test_the_documented_plugin_blows():
    wind = "<plugin name='w' filename='libmy_wind.so'><link_name>link</link_name><force>3 0 0</force></plugin>"
    simulation = Simulation(world(box("b", pose="0 0 9 0 0 0", mass=2).replace("</model>", f"{wind}</model>")))
    simulation.advance(1_000_000_000)
    assert simulation.pose("b").position[0] == pytest.approx(0.75, rel=0.01)  # a t^2 / 2
