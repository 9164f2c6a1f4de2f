"""Files that are missing or faulty: one line that says where, exit status 2, and nothing half done."""

from pathlib import Path

import pytest

from end_to_end.processes import DAIDALOS, ROS2, finished

FILES = {
    "sizes.urdf": '<robot name="r">\n  <link name="l">\n    <visual><geometry><box size="1 2"/></geometry></visual>\n'
    "  </link>\n</robot>\n",
    "torn.urdf": '<robot name="r">\n  <link name="l">\n</robot>\n',
    "names.xacro": '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '  <link name="l${unknown}"/>\n</robot>\n',
    "numbers.world": '<sdf version="1.6">\n<world name="w">\n<model name="m"><link name="l"><collision name="c">\n'
    "<geometry><box><size>1 x 1</size></box></geometry></collision></link></model>\n</world>\n</sdf>\n",
    "torn.world": '<sdf version="1.6">\n<world name="w">\n',
    "names.launch.py": "from launch import LaunchDescription\n\n\ndef generate_launch_description():\n"
    "    return LaunchDescription([Nod()])\n",
    "tags.launch.xml": '<launch>\n  <nod pkg="a"/>\n</launch>\n',
    "fields.launch.yaml": "launch:\n  - node: [\n",
    "nonsense.mcap": "nonsense\n",
}
PUBLISH = [*ROS2, "run", "robot_state_publisher", "robot_state_publisher"]
SERVE = [*ROS2, "run", "gazebo_ros", "gzserver"]
LAUNCH = [*ROS2, "launch"]
MAP = [*DAIDALOS, "map", "-o", "built"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "name", "error"),
    [
        (PUBLISH, "missing.urdf", "missing.urdf"),
        (PUBLISH, "sizes.urdf", "sizes.urdf:3: <box>"),
        (PUBLISH, "torn.urdf", "torn.urdf:3: not well-formed XML"),
        (PUBLISH, "names.xacro", "names.xacro:2: name 'unknown' is not defined"),
        (SERVE, "missing.world", "missing.world"),
        (SERVE, "numbers.world", "numbers.world:4: <size>"),
        (SERVE, "torn.world", "torn.world:3: not well-formed XML"),
        (LAUNCH, "missing.launch.py", "missing.launch.py"),
        (LAUNCH, "names.launch.py", "names.launch.py:5: NameError: name 'Nod' is not defined"),
        (LAUNCH, "tags.launch.xml", "tags.launch.xml:2: "),
        (LAUNCH, "fields.launch.yaml", "fields.launch.yaml:3: "),
        (MAP, "missing.mcap", "missing.mcap"),
        (MAP, "nonsense.mcap", "nonsense.mcap: not a readable bag"),
    ],
    ids=lambda value: value if isinstance(value, str) and "." in value and ":" not in value else "",
)
def test_a_faulty_file_is_named_in_one_line(
    command: list[str], name: str, error: str, domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for file, text in FILES.items():
        (tmp_path / file).write_text(text)
    done = finished(*command, name, domain=domain, timeout=60)
    assert done.returncode == 2, done.stderr
    told = [line for line in done.stderr.splitlines() if "[INFO]" not in line]
    assert len(told) == 1, done.stderr
    assert error in told[0]
    assert {path.name for path in tmp_path.iterdir()} == set(FILES), "something was half written"
