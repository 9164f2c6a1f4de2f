"""Parameter files that are rewritten on their way to nodes."""

import sys

import pytest
import yaml
from launch import LaunchContext
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, SubstitutionFailure
from launch_ros.descriptions import ParameterFile
from nav2_common.launch import HasNodeParams, LaunchConfigAsBool, ParseMultiRobotPose, ReplaceString, RewrittenYaml

TEXT = """
amcl:
  ros__parameters:
    use_sim_time: false
    scan_topic: scan
    tolerance: 1e-3
    robot_model_type: "nav2_amcl::DifferentialMotionModel"
local_costmap:
  local_costmap:
    ros__parameters:
      use_sim_time: false
      plugins: [static_layer, ZONES]
      static_layer: {topic: /map, enabled: KEEPOUT_ZONE_ENABLED}
list:
  - name: a
  - name: b
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "params.yaml"
    path.write_text(TEXT)
    return str(path)


@pytest.fixture
def context():
    context = LaunchContext()
    context.launch_configurations.update({"sim": "True", "ns": "robot1", "number": "0.25", "empty": ""})
    return context


def perform(substitution, context):
    with open(substitution.perform(context)) as written:
        return yaml.safe_load(written)


def test_a_key_is_rewritten_wherever_it_is(file, context):
    data = perform(RewrittenYaml(file, {"use_sim_time": LaunchConfiguration("sim")}, convert_types=True), context)
    expected = yaml.safe_load(TEXT.replace("use_sim_time: false", "use_sim_time: true"))
    assert data == expected


def test_whole_paths_are_rewritten_or_added(file, context):
    rewrites = {
        "amcl.ros__parameters.scan_topic": ["/", LaunchConfiguration("ns"), "/scan"],
        "list.1.name": "c",
        "amcl.ros__parameters.laser.range": LaunchConfiguration("number"),
        "planner.ros__parameters.frequency": "20",
        "nowhere.at_all": "5",
    }
    data = perform(RewrittenYaml(file, rewrites, convert_types=True), context)
    assert data["amcl"]["ros__parameters"]["scan_topic"] == "/robot1/scan"
    assert data["list"] == [{"name": "a"}, {"name": "c"}]
    assert data["amcl"]["ros__parameters"]["laser"] == {"range": 0.25}
    assert data["planner"] == {"ros__parameters": {"frequency": 20}}
    assert "nowhere" not in data


def test_types_are_converted_only_where_that_is_asked_for(file, context):
    rewrites = {"scan_topic": "5", "tolerance": "TRUE", "topic": "2.5e-1"}
    node = perform(RewrittenYaml(file, rewrites), context)
    assert (node["amcl"]["ros__parameters"]["scan_topic"], node["amcl"]["ros__parameters"]["tolerance"]) == ("5", True)
    node = perform(RewrittenYaml(file, rewrites, convert_types=True), context)
    assert node["amcl"]["ros__parameters"]["scan_topic"] == 5
    assert node["local_costmap"]["local_costmap"]["ros__parameters"]["static_layer"]["topic"] == 0.25


def test_root_keys_keys_and_values(file, context):
    data = perform(
        RewrittenYaml(
            file,
            {},
            root_key=LaunchConfiguration("ns"),
            key_rewrites={"amcl": "localizer", "static_layer": "still_layer"},
            value_rewrites={"KEEPOUT_ZONE_ENABLED": LaunchConfiguration("sim"), "ZONES": "zones"},
        ),
        context,
    )
    assert list(data) == ["robot1"]
    assert list(data["robot1"]) == ["localizer", "local_costmap", "list"]
    costmap = data["robot1"]["local_costmap"]["local_costmap"]["ros__parameters"]
    assert costmap["plugins"] == ["static_layer", "zones"]
    assert costmap["still_layer"] == {"topic": "/map", "enabled": True}
    assert perform(RewrittenYaml(file, {}, root_key=LaunchConfiguration("empty")), context) == yaml.safe_load(TEXT)


def test_what_is_not_rewritten_is_written_as_it_was(file, context):
    with open(RewrittenYaml(file, {}).perform(context)) as written:
        # YAML 1.1 takes it for a text, ROS for a number; quoted, it would be a text for both.
        assert "tolerance: 1e-3\n" in written.read()


def test_a_rewritten_file_may_have_substitutions(file, context):
    source = ReplaceString(file, {"scan_topic: scan": "scan_topic: $(var ns)/scan"})
    parameters = ParameterFile(RewrittenYaml(source, {"topic": "/floor"}), allow_substs=True)
    assert (
        yaml.safe_load(parameters.evaluate(context).read_text())["amcl"]["ros__parameters"]["scan_topic"]
        == "robot1/scan"
    )


def test_text_is_replaced_under_a_condition(file, context):
    for switch, replaced in (("True", True), ("False", False)):
        substitution = ReplaceString(
            source_file=file,
            replacements={"static_layer": LaunchConfiguration("ns")},
            condition=IfCondition(switch),
        )
        path = substitution.perform(context)
        assert (path != file) == replaced
        with open(path) as written:
            assert written.read() == (TEXT.replace("static_layer", "robot1") if replaced else TEXT)


def test_whether_a_file_is_about_a_node(file, context, tmp_path):
    assert HasNodeParams(source_file=file, node_name="amcl").perform(context) == "True"
    assert HasNodeParams(file, "slam_toolbox").perform(context) == "False"
    (tmp_path / "empty.yaml").write_text("")
    assert HasNodeParams(str(tmp_path / "empty.yaml"), "amcl").perform(context) == "False"


@pytest.mark.parametrize(
    ("text", "switch"), [("1", "True"), ("Yes", "True"), ("on", "True"), ("off", "False"), ("2", "False")]
)
def test_arguments_that_are_switches(context, text, switch):
    context.launch_configurations["use"] = text
    assert LaunchConfigAsBool("use").perform(context) == switch


def test_mistakes_name_the_file(tmp_path, context):
    missing = str(tmp_path / "missing.yaml")
    for substitution in (RewrittenYaml(missing, {}), ReplaceString(missing, {}), HasNodeParams(missing, "a")):
        with pytest.raises(SubstitutionFailure, match=r"cannot read the parameter file '.*missing\.yaml'"):
            substitution.perform(context)
    (tmp_path / "bad.yaml").write_text("a: [")
    with pytest.raises(SubstitutionFailure, match=r"bad\.yaml' is not YAML"):
        RewrittenYaml(str(tmp_path / "bad.yaml"), {}).perform(context)


def test_robots_and_their_poses(monkeypatch):
    argument = "robots:=a={x: 1.0, y: 2, yaw: 1.57}; b={x: -1.0, z: 0.5};"
    monkeypatch.setattr(sys, "argv", ["ros2", "launch", "package", "file", argument])
    poses = ParseMultiRobotPose("robots").value()
    assert [(name, *pose.values()) for name, pose in poses.items()] == [
        ("a", 1.0, 2.0, 0.0, 0.0, 0.0, 1.57),
        ("b", -1.0, 0.0, 0.5, 0.0, 0.0, 0.0),
    ]
    assert list(poses["a"]) == ["x", "y", "z", "roll", "pitch", "yaw"]
    assert ParseMultiRobotPose("others").value() == {}


@pytest.mark.parametrize("text", ["a", "={x: 1}", "a={x: 1", "a=[1, 2]", "a={x: far}", "a={speed: 1}"])
def test_what_is_no_robot(monkeypatch, text):
    monkeypatch.setattr(sys, "argv", ["ros2", f"robots:={text}"])
    with pytest.raises(ValueError, match="the launch argument 'robots' has"):
        ParseMultiRobotPose("robots").value()
