"""Parameters of MoveIt and of other nodes out of a package's files."""

import pytest
from launch import LaunchContext
from launch.substitutions import LaunchConfiguration
from launch_param_builder import ParameterBuilder, ParameterBuilderFileNotFoundError
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import (
    generate_demo_launch,
    generate_move_group_launch,
    generate_moveit_rviz_launch,
    generate_rsp_launch,
    generate_spawn_controllers_launch,
    generate_static_virtual_joint_tfs_launch,
)

FILES = {
    "config/arm.urdf.xacro": '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="tip"'
    ' default="tool"/><link name="$(arg tip)"/></robot>',
    "config/arm.srdf": '<robot name="arm"><virtual_joint name="v" type="fixed" parent_frame="world" child_link="base"/>'
    "</robot>",
    "config/kinematics.yaml": "arm: {kinematics_solver: kdl}",
    "config/joint_limits.yaml": "joint_limits: {j1: {max_velocity: 1.0}}",
    "config/moveit_controllers.yaml": "moveit_simple_controller_manager: {controller_names: [arm_controller]}",
    "config/pilz_cartesian_limits.yaml": "cartesian_limits: {max_trans_vel: 1.0}",
    "config/note.txt": "hello",
    ".setup_assistant": "moveit_setup_assistant_config: {SRDF: {relative_path: config/arm.srdf}}",
}


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A configuration package as MoveIt's assistant writes it."""
    share = tmp_path / "share" / "arm_moveit_config"
    for name, text in FILES.items():
        (share / name).parent.mkdir(parents=True, exist_ok=True)
        (share / name).write_text(text)
    index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "arm_moveit_config").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    return share


def test_everything_is_found_where_the_assistant_writes_it(package):
    parameters = MoveItConfigsBuilder("arm").to_dict()
    assert 'name="tool"' in parameters["robot_description"]
    assert "virtual_joint" in parameters["robot_description_semantic"]
    assert parameters["robot_description_kinematics"]["arm"]["kinematics_solver"] == "kdl"
    assert parameters["default_planning_pipeline"] == "ompl"
    assert parameters["ompl"]["planner_configs"]["RRTConnect"] == {"type": "geometric::RRTConnect"}
    assert parameters["moveit_simple_controller_manager"]["controller_names"] == ["arm_controller"]
    limits = parameters["robot_description_planning"]
    assert (limits["joint_limits"]["j1"]["max_velocity"], limits["cartesian_limits"]["max_trans_vel"]) == (1.0, 1.0)


def test_arguments_of_xacro_are_texts_or_substitutions(package):
    text = MoveItConfigsBuilder("arm").robot_description(mappings={"tip": "hand"}).to_moveit_configs()
    assert 'name="hand"' in text.robot_description["robot_description"]
    late = MoveItConfigsBuilder("arm").robot_description(mappings={"tip": LaunchConfiguration("tip")})
    value = late.to_moveit_configs().robot_description["robot_description"]
    context = LaunchContext()
    context.launch_configurations["tip"] = "claw"
    assert 'name="claw"' in value.evaluate(context)


def test_faults_are_named(package):
    with pytest.raises(RuntimeError, match="`chump` doesn't name any"):
        MoveItConfigsBuilder("arm").planning_pipelines("chump")
    (package / "config/moveit_controllers.yaml").rename(package / "config/a_controllers.yaml")
    (package / "config/b_controllers.yaml").write_text("{}")
    with pytest.raises(RuntimeError, match=r"a_controllers\.yaml\n - b_controllers\.yaml"):
        MoveItConfigsBuilder("arm").trajectory_execution()
    with pytest.raises(ParameterBuilderFileNotFoundError, match=r"nothing\.yaml doesn't exist"):
        MoveItConfigsBuilder("arm").joint_limits("nothing.yaml")
    (package / "config/joint_limits.yaml").write_text("a: 1\nb: [")
    with pytest.raises(ValueError, match=r"joint_limits\.yaml:2: "):
        MoveItConfigsBuilder("arm").joint_limits()


def test_launches(package):
    config = MoveItConfigsBuilder("arm").to_moveit_configs()
    assert len(generate_static_virtual_joint_tfs_launch(config).entities) == 1
    assert len(generate_spawn_controllers_launch(config).entities) == 2
    for generate in (
        generate_rsp_launch,
        generate_moveit_rviz_launch,
        generate_move_group_launch,
        generate_demo_launch,
    ):
        assert generate(config).get_launch_arguments()


def test_parameters_are_put_together(package):
    builder = ParameterBuilder("arm_moveit_config").parameter("rate", 20.0).yaml("config/kinematics.yaml")
    builder.yaml("config/joint_limits.yaml", parameter_namespace="limits").file_parameter("note", "config/note.txt")
    builder.xacro_parameter("robot", "config/arm.urdf.xacro", {"tip": "x"}).path_parameter("path", "config/note.txt")
    parameters = builder.to_dict()
    assert parameters["limits"] == {"joint_limits": {"j1": {"max_velocity": 1.0}}}
    assert (parameters["rate"], parameters["note"]) == (20.0, "hello")
    assert parameters["path"] == str(package / "config/note.txt")
