import re
from importlib import metadata
from importlib.metadata import EntryPoint

import pytest

from daidalos.common.extensions import UnknownExtension, find
from daidalos.description.link import Plugin as Description
from daidalos.description.markup import Element
from daidalos.samples.sensors import TransformSample
from daidalos.simulation import Simulation
from daidalos.simulation.contracts import Plugin, Sensor
from daidalos.simulation.extensions import PLUGINS, SENSORS
from daidalos.simulation.libraries import is_built_in, library_name, library_of
from daidalos.simulation.plugins.diff_drive import DiffDrive
from daidalos.simulation.sensors.camera import Camera
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


def plugin_class(name, filename):
    return find(PLUGINS, library_of(written(name, filename)))


def test_ours_are_found():
    assert find(SENSORS, "gpu_lidar") is Lidar
    assert plugin_class("p", "libgazebo_ros_diff_drive.so") is DiffDrive
    assert plugin_class("ignition::gazebo::v6::systems::DiffDrive", "gz-sim-systems") is DiffDrive
    assert is_built_in(written("ignition::gazebo::systems::v0::Physics", "libignition-gazebo-systems.so"))
    with pytest.raises(UnknownExtension):
        plugin_class("diff_drive", "libnothing.so")


def test_unknown_names_are_warned_of_with_their_file_and_the_nearest():
    text = box("b", extra="<sensor name='s' type='gpu_lidr'/>")
    text = text.replace("</model>", "<plugin name='g' filename='libgazebo_ros_diff_drve.so'/></model>")
    warnings = Simulation(world(text)).warnings
    assert any(
        re.search(r":\d+: 's': there is no sensor 'gpu_lidr'; did you mean 'gpu_lidar'", line) for line in warnings
    ), warnings
    assert any(
        re.search(r":\d+: 'g': there is no simulator plugin 'gazebo_ros_diff_drve'; did you mean 'gazebo_ros_di", line)
        for line in warnings
    ), warnings


class Greeter(Plugin):
    period = 0.5

    def update(self, now_ns):
        self.state = (self.state or 0) + 1
        yield TransformSample(now_ns, "/hello", "a", "b", (self.state, 0, 0), (0, 0, 0, 1))


class Nose(Sensor):
    names = ("nose",)

    def measure(self, now_ns):
        yield TransformSample(now_ns, self.topic, self.frame_id, "smell", (0, 0, 0), (0, 0, 0, 1))


def documented_plugin():
    """The class that the documentation shows."""
    page = (REPOSITORY / "docs" / "simulation.md").read_text()
    names = {}
    exec(re.search(r"```python\n(.*?)```", page, re.DOTALL)[1], names)
    return names["Wind"]


@pytest.fixture
def entries(monkeypatch):
    points = [
        EntryPoint("greeter", f"{__name__}:Greeter", "daidalos.plugins"),
        EntryPoint("my_wind", f"{__name__}:documented_plugin.found", "daidalos.plugins"),
        EntryPoint("nose", f"{__name__}:Nose", "daidalos.sensors"),
    ]
    documented_plugin.found = documented_plugin()
    monkeypatch.setattr(metadata, "entry_points", lambda group: [one for one in points if one.group == group])


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
        assert is_built_in(written("p", name)) or plugin_class("p", name)


@pytest.mark.usefixtures("entries")
def test_the_documented_plugin_blows():
    wind = "<plugin name='w' filename='libmy_wind.so'><link_name>link</link_name><force>3 0 0</force></plugin>"
    simulation = Simulation(world(box("b", pose="0 0 9 0 0 0", mass=2).replace("</model>", f"{wind}</model>")))
    simulation.advance(1_000_000_000)
    assert simulation.pose("b").position[0] == pytest.approx(0.75, rel=0.01)  # a t^2 / 2


@pytest.mark.parametrize("name", ["camera", "rgbd_camera", "depth_camera", "multicamera", "wideanglecamera"])
def test_cameras_are_found_by_their_names(name):
    assert issubclass(find(SENSORS, name), Camera)
    assert "Ellipsis" not in Camera.names
    with pytest.raises(UnknownExtension):
        find(SENSORS, "Ellipsis")
