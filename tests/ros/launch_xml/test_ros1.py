"""Launch files of ROS 1: recognized, translated, run."""

import io
import re
import shlex
import sys
import textwrap
from pathlib import Path

import pytest
import yaml
from launch_xml import Parser
from launch_xml._reader import read_xml
from launch_xml.ros1 import is_ros1, packages

SHOW = """
import json, sys, yaml
parameters = {}
arguments = sys.argv[2:]
for option, value in zip(arguments, arguments[1:]):
    if option == '--params-file':
        for section in yaml.safe_load(open(value)).values():
            parameters.update(section['ros__parameters'])
    if option == '-p':
        name, _, text = value.partition(':=')
        parameters[name] = yaml.safe_load(text)
end = arguments.index('--ros-args')
remaps = [value for option, value in zip(arguments, arguments[1:]) if option == '-r']
print('RAN ' + json.dumps([sys.argv[1], arguments[:end], remaps, parameters]))
"""


@pytest.fixture
def ran(monkeypatch, capsys, run_text):
    """Run the text of a launch file; return what each node was given: arguments, remappings, parameters."""
    monkeypatch.setattr(
        "daidalos.workspaces.executables.find_executable",
        lambda package, executable: [sys.executable, "-c", SHOW, f"{package}/{executable}"],
    )
    monkeypatch.setenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "screen")

    def run(text, **configurations):
        run_text(text, **configurations)
        printed = capsys.readouterr().out
        nodes = {}
        for line in re.findall(r"RAN (.*)", printed):
            node, *rest = yaml.safe_load(line)
            nodes[node] = rest
        return nodes, printed

    return run


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package with files in it."""
    prefix = tmp_path / "prefix"
    share = prefix / "share" / "robot"
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    for folder in (share / "launch", index):
        folder.mkdir(parents=True)
    (index / "robot").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    return share


@pytest.mark.parametrize(
    ("text", "old"),
    [
        ("<launch><node pkg='p' type='t' name='n'/></launch>", True),
        ("<launch><node pkg='p' exec='t'/></launch>", False),
        ("<launch><param name='a' value='1'/></launch>", True),
        ("<launch><node pkg='p' exec='t'><param name='a' value='1'/></node></launch>", False),
        ("<launch><arg name='a' value='1'/></launch>", True),
        ("<launch><arg name='a' default='1'/></launch>", False),
        ("<launch><include file='x'><arg name='a' value='1'/></include></launch>", False),
        ("<launch><include file='$(find p)/x'/></launch>", True),
        ("<launch><include file='$(find-pkg-share p)/x'/></launch>", False),
        ("<launch><log message='$(arg x)'/></launch>", True),
        ("<launch><log message='$(var x)'/></launch>", False),
        ("<launch><group ns='x'/></launch>", True),
        ("<launch><rosparam file='x'/></launch>", True),
        ("<launch><remap from='a' to='b'/></launch>", True),
        ("<launch><machine name='a'/></launch>", True),
        ("<launch><node pkg='p' exec='t'><param name='a' command='c'/></node></launch>", True),
        ("<launch/>", False),
    ],
)
def test_recognition(text, old):
    assert is_ros1(read_xml(text, None)) is old


def test_node(ran):
    nodes, printed = ran(
        """
        <launch>
            <arg name="words" default="a b"/>
            <node pkg="p" type="t.py" name="n" ns="space" args="-x $(arg words) 'c d'" output="screen" respawn="false">
                <param name="~private" value="1"/>
                <param name="a/b" value="2.5" type="double"/>
                <param name="text" value="007" type="str"/>
                <param name="truth" value="true"/>
                <remap from="in" to="/out"/>
            </node>
        </launch>
        """
    )
    arguments, remaps, parameters = nodes["p/t.py"]
    assert arguments == ["-x", "a", "b", "c d"]
    assert remaps == ["__node:=n", "__ns:=/space", "in:=/out"]
    assert parameters == {"private": 1, "a.b": 2.5, "text": "007", "truth": True}
    assert "is one of ROS 1 and was translated" in printed


def test_rules_among_the_arguments(ran):
    nodes, _ = ran('<launch><node pkg="p" type="t" name="n" args="x scan:=/s _rate:=5 __ns:=/up __log:=f y"/></launch>')
    arguments, remaps, parameters = nodes["p/t"]
    assert arguments == ["x", "y"]
    assert remaps == ["scan:=/s", "__ns:=/up", "__node:=n"]
    assert parameters == {"rate": 5}


def test_required_nodes_end_the_launch(ran):
    _, printed = ran('<launch><node pkg="p" type="t" name="n" required="true"/></launch>')
    assert "was required: shutting down" in printed


def test_parameters_for_all_nodes_come_before_any(ran, tmp_path):
    (tmp_path / "file.txt").write_text('text "with" $(x)\n')
    nodes, _ = ran(
        f"""
        <launch>
            <node pkg="p" type="t" name="n"/>
            <arg name="word" default="w"/>
            <node pkg="p" type="later" name="n2"/>
            <param name="/global" value="$(arg word)"/>
            <param name="from_command" command="echo '$(arg word): &quot;x&quot; # y'"/>
            <param name="from_file" textfile="{tmp_path}/file.txt"/>
        </launch>
        """
    )
    assert nodes["p/t"][2] == {}
    assert nodes["p/later"][2] == {
        "global": "w",
        "from_command": 'w: "x" # y\n',
        "from_file": 'text "with" $(x)\n',
    }


def test_parameter_files(ran, package):
    (package / "a.yaml").write_text("x: 1\nnested: {y: [1, 2]}\nfootprint: [[0, 1], [2, 3]]\nsubst: $(arg a)\n")
    nodes, _ = ran(
        """
        <launch>
            <arg name="a" value="5"/>
            <rosparam>
                everywhere: {deep: true}
                $(arg a): dollar
            </rosparam>
            <rosparam command="load" file="$(find robot)/a.yaml" ns="all"/>
            <node pkg="p" type="t" name="n">
                <rosparam command="load" file="$(find robot)/a.yaml" ns="ns1/ns2"/>
                <rosparam file="$(find robot)/a.yaml" subst_value="true"/>
                <rosparam param="list">[1, 2]</rosparam>
                <rosparam subst_value="true">own: $(arg a)</rosparam>
                <param name="x" value="over"/>
            </node>
            <rosparam command="delete" param="x"/>
        </launch>
        """
    )
    plain = {"x": 1, "nested.y": [1, 2], "footprint": "[[0, 1], [2, 3]]", "subst": "$(arg a)"}
    assert nodes["p/t"][2] == {
        "everywhere.deep": True,
        "$(arg a)": "dollar",
        **{f"all.{name}": value for name, value in plain.items()},
        **{f"ns1.ns2.{name}": value for name, value in plain.items()},
        **plain,
        "subst": 5,
        "list": [1, 2],
        "own": 5,
        "x": "over",
    }


@pytest.mark.parametrize(
    ("content", "reason"),
    [("a: [", "is not YAML"), ("just text", "has no names of parameters"), (None, "cannot be read")],
)
def test_broken_parameter_files(run_text, tmp_path, content, reason):
    path = tmp_path / "a.yaml"
    if content is not None:
        path.write_text(content)
    service = run_text(f'<launch><rosparam file="{path}"/></launch>', expected=1)
    assert reason in service.error.reason


def test_substitutions(ran, package, monkeypatch):
    monkeypatch.setenv("LT_A", "env")
    nodes, _ = ran(
        r"""
        <launch>
            <arg name="n" default="3"/>
            <arg name="name" default="bob"/>
            <arg name="sum" value="$(eval n + 1)"/>
            <arg name="mixed"
                value="$(eval 'robot' + str(arg('n') * 2) + name + env('LT_A') + optenv('LT_B', &quot;q&quot;))"/>
            <arg name="where" value="$(eval find('robot'))"/>
            <node pkg="p" type="t" name="n" args="$(arg sum) $(arg mixed) $(env LT_A) $(optenv LT_B) $(optenv LT_B x y)
                $(find robot) $(arg where)" if="$(eval n == 3 and name == 'bob')"/>
            <node pkg="p" type="never" name="n" unless="$(eval n > 2)"/>
        </launch>
        """
    )
    share = str(package)
    assert nodes["p/t"][0] == ["4", "robot6bobenvq", "env", "x", "y", share, share]
    assert "p/never" not in nodes


def test_wrong_expressions(run_text):
    service = run_text('<launch><arg name="a" value="$(eval nothing + 1)"/></launch>', expected=1)
    assert "$(eval nothing + 1) failed: NameError" in service.error.reason


def test_groups_remaps_and_environment(ran):
    nodes, _ = ran(
        """
        <launch>
            <env name="LT_A" value="x"/>
            <remap from="a" to="b"/>
            <group ns="one">
                <remap from="c" to="d"/>
                <group ns="two"><node pkg="p" type="inner" name="n"/></group>
            </group>
            <node pkg="p" type="outer" name="n" args="$(env LT_A)"><env name="LT_B" value="y"/></node>
        </launch>
        """
    )
    assert nodes["p/inner"][1] == ["__node:=n", "__ns:=/one/two", "a:=b", "c:=d"]
    assert nodes["p/outer"][:2] == [["x"], ["__node:=n", "a:=b"]]


def test_includes_have_their_own_arguments_and_share_parameters(ran, package):
    (package / "launch" / "inner.launch").write_text(
        textwrap.dedent(
            """
            <launch>
                <arg name="a" default="inner default"/>
                <arg name="b"/>
                <param name="from_inner" value="$(arg a)/$(arg b)"/>
                <node pkg="p" type="inner" name="n" args="$(arg b)"/>
            </launch>
            """
        )
    )
    nodes, printed = ran(
        """
        <launch>
            <arg name="a" default="outer"/>
            <arg name="b" default="outer b"/>
            <include file="$(find robot)/launch/inner.launch" ns="space"><arg name="b" value="$(arg a)!"/></include>
            <node pkg="p" type="outer" name="n" args="$(arg a) $(arg b)"/>
            <include file="$(find robot)/launch/inner.launch" pass_all_args="true"/>
            <node pkg="p" type="last" name="n"/>
        </launch>
        """
    )
    assert nodes["p/outer"][0] == ["outer", "outer", "b"]
    assert nodes["p/last"][2] == {"from_inner": "outer/outer b"}
    # Either of the two may be the last to print.
    assert 'RAN ["p/inner", ["outer!"], ' in printed
    assert 'RAN ["p/inner", ["outer", "b"], ' in printed


def test_conditions_inside_nodes(ran):
    nodes, _ = ran(
        """
        <launch>
            <arg name="yes" default="true"/>
            <node pkg="p" type="t" name="n" if="$(arg yes)">
                <param name="a" value="1" if="$(arg yes)"/>
                <param name="b" value="2" unless="$(arg yes)"/>
                <remap from="x" to="y" if="0"/>
            </node>
        </launch>
        """
    )
    assert nodes["p/t"][1:] == [["__node:=n"], {"a": 1}]


def test_what_is_left_out_is_said(ran):
    _, printed = ran(
        """
        <launch>
            <machine name="m" address="a"/>
            <test pkg="p" type="t" test-name="x"/>
            <param name="binary" binfile="x"/>
        </launch>
        """
    )
    assert "'machine' was left out" in printed
    assert "'test' was left out" in printed
    assert "'binary' was left out" in printed


def test_mistakes_are_located(run_text):
    root, parser = Parser.load(io.StringIO("<launch>\n<node pkg='p' type='t' name='n'><colour/></node></launch>"))
    with pytest.raises(ValueError, match=r"found in `ros1:node`: colour"):
        parser.parse_description(root)
    service = run_text("<launch>\n\n<arg name='a' value='$(arg b)'/></launch>", expected=1)
    assert (service.error.line, service.error.reason) == (3, "launch configuration 'b' does not exist")


def test_known_nodes(ran):
    nodes, printed = ran(
        """
        <launch>
            <node pkg="amcl" type="amcl" name="amcl">
                <param name="odom_model_type" value="diff-corrected"/>
                <param name="laser_max_beams" value="30"/>
                <param name="gui_publish_rate" value="10.0"/>
                <param name="base_frame_id" value="base"/>
            </node>
            <node pkg="map_server" type="map_server" name="map_server" args="$(optenv LT_NONE /maps)/arena.yaml"/>
            <node pkg="tf" type="static_transform_publisher" name="s" args="1 2 3 0 0 0 a b 100"/>
            <node pkg="gazebo_ros" type="spawn_model" name="s"
                args="-urdf -param robot_description -model waffle -x 1 -Y $(optenv LT_NONE 2)"/>
        </launch>
        """
    )
    assert nodes["amcl/amcl"][2] == {
        "odom_model_type": "diff-corrected",
        "laser_max_beams": 30,
        "gui_publish_rate": 10.0,
        "base_frame_id": "base",
    }
    assert nodes["map_server/map_server"][::2] == [["/maps/arena.yaml"], {}]
    assert nodes["tf2_ros/static_transform_publisher"][0] == shlex.split("1 2 3 0 0 0 a b")
    assert nodes["gazebo_ros/spawn_entity.py"][0] == shlex.split("-topic robot_description -entity waffle -x 1 -Y 2")
    assert "node tf/static_transform_publisher -> tf2_ros/static_transform_publisher" in printed


def test_programs_are_called_by_their_names(ran, package):
    (package / "robot.urdf.xacro").write_text('<robot name="r"><!-- a: b --><link name="base"/></robot>')
    nodes, _ = ran(
        """
        <launch>
            <param name="robot_description" command="$(find xacro)/xacro --inorder $(find robot)/robot.urdf.xacro"/>
            <node pkg="p" type="t" name="n"/>
        </launch>
        """
    )
    assert '<link name="base"/>' in nodes["p/t"][2]["robot_description"]


SEED = Path(__file__).resolve().parents[4] / "shared" / "seeds"


def seed_launch_files():
    for file in sorted(SEED.glob("001_*.txt")):
        blocks = re.findall(r"```\n(.*?)```", file.read_text(encoding="utf-8"), re.DOTALL)
        yield from (block.lstrip() for block in blocks if "<launch>" in block)


@pytest.mark.slow
@pytest.mark.skipif(not SEED.is_dir(), reason="the document with ROS 1 launch files is not beside the checkout")
def test_launch_files_of_the_tutorial(ran, tmp_path, monkeypatch):
    for package in ("tb3_gazebo", "tb3_description", "tb3_navigation", "gazebo_ros"):
        share = tmp_path / "prefix" / "share" / package
        for folder in ("launch", "urdf", "cfg", "map", "worlds"):
            (share / folder).mkdir(parents=True)
        index = tmp_path / "prefix" / "share" / "ament_index" / "resource_index" / "packages"
        index.mkdir(parents=True, exist_ok=True)
        (index / package).touch()
    share = tmp_path / "prefix" / "share"
    (share / "tb3_description" / "urdf" / "turtlebot3_waffle_base.urdf.xacro").write_text("<robot name='r'/>")
    for name in ("costmap_common", "global_costmap", "local_costmap", "global_planner", "teb_local_planner"):
        (share / "tb3_navigation" / "cfg" / f"{name}_params.yaml").write_text(f"{name}: 1\n")
    for name in ("costmap_converter", "move_base"):
        (share / "tb3_navigation" / "cfg" / f"{name}_params.yaml").write_text(f"{name}: 1\n")
    (share / "gazebo_ros" / "launch" / "gazebo.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.substitutions import *\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([\n"
        "        DeclareLaunchArgument('world'), LogInfo(msg=['world ', LaunchConfiguration('world')])])\n"
    )
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    nodes, printed = {}, ""
    files = list(seed_launch_files())
    for text in files:
        found, more = ran(text)
        nodes.update(found)
        printed += more
    assert len(files) == 7
    assert f"world {share}/tb3_gazebo/worlds/arena_2018.world" in printed
    assert nodes["hector_mapping/hector_mapping"][2]["map_resolution"] == 0.025
    assert nodes["hector_mapping/hector_mapping"][2]["map_multi_res_levels"] == 4
    assert nodes["map_server/map_server"][0] == [f"{share}/tb3_navigation/map/arena.yaml"]
    assert nodes["amcl/amcl"][2]["max_particles"] == 2000
    assert nodes["move_base/move_base"][2]["global_costmap.costmap_common"] == 1
    assert nodes["robot_state_publisher/robot_state_publisher"][2]["publish_frequency"] == 30.0
    assert set(nodes) >= {"a_pkg/a_pub.py", "a_pkg/a_sub.py", "gazebo_ros/spawn_entity.py"}


def test_table_is_sound():
    for (package, executable), mapping in packages.NODES.items():
        assert package
        assert executable
        assert mapping.package
        assert mapping.executable
        assert set(mapping.values) <= set(mapping.parameters.values())


@pytest.mark.parametrize(
    ("package", "name", "expected"),
    [
        ("demo_nodes_py", "talker.py", "talker"),
        ("demo_nodes_py", "talker", "talker"),
        ("demo_nodes_py", "nope.py", "nope.py"),
        ("no_such_package", "talker.py", "talker.py"),
        ("$(arg package)", "talker.py", "talker.py"),
    ],
)
def test_scripts_may_have_lost_their_ending(package, name, expected):
    assert packages.ros2_program(package, name) == expected
