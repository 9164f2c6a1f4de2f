"""True odometry, forces, grippers, joints that follow topics, and plugins that nobody knows."""

import math

import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.samples.commands import NumberCommand, PositionTrajectoryCommand, WrenchCommand
from daidalos.samples.sensors import FlagSample, NavSatSample, OdometrySample
from daidalos.simulation import Simulation
from simulation.models import box, world
from simulation.plugins.vehicles import four_wheels

SECOND = 1_000_000_000


def with_plugin(model, filename, parameters=""):
    return model.replace("</model>", f"<plugin name='p' filename='{filename}'>{parameters}</plugin></model>")


def last(samples, kind=OdometrySample):
    return [s for s in samples if isinstance(s, kind)][-1]


def test_p3d_tells_the_truth():
    parameters = (
        "<ros><remapping>odom:=truth</remapping></ros><body_name>link</body_name><frame_name>map</frame_name>"
        "<update_rate>50</update_rate><xyz_offsets>10 0 0</xyz_offsets>"
    )
    simulation = Simulation(world(with_plugin(box("b", "1 2 5 0 0 0.5"), "libgazebo_ros_p3d.so", parameters)))
    simulation.set_velocity("b", (1.0, 0, 0), (0, 0, 0))
    odometry = last(simulation.advance(SECOND // 2))
    assert (odometry.topic, odometry.frame_id, odometry.child_frame_id) == ("/truth", "map", "link")
    assert odometry.position == pytest.approx((10 + 1.5, 2, 5 - 0.5 * 9.8 * 0.25), abs=0.01)
    assert odometry.linear[:2] == pytest.approx((np.cos(0.5), -np.sin(0.5)), abs=1e-3)  # in the body's axes


def test_ros1s_p3d_has_its_own_words():
    parameters = "<bodyName>link</bodyName><topicName>truth</topicName><frameName>/world</frameName>"
    simulation = Simulation(world(with_plugin(box("b"), "libgazebo_ros_p3d.so", parameters)))
    assert last(simulation.advance(10_000_000)).frame_id == "world"


def test_gzs_odometry_publisher_starts_at_zero():
    simulation = Simulation(world(with_plugin(box("b", "4 5 0.5 0 0 1"), "gz-sim-odometry-publisher-system")))
    odometry = last(simulation.advance(SECOND // 10))
    assert odometry.position[:2] == pytest.approx((0, 0), abs=1e-6)
    assert odometry.topic == "/model/b/odometry"


def test_gzs_pose_publisher_tells_links_and_model():
    parameters = "<publish_model_pose>true</publish_model_pose><update_frequency>50</update_frequency>"
    model = with_plugin(box("b", "1 2 0.5 0 0 0"), "gz-sim-pose-publisher-system", parameters)
    samples = Simulation(world(model)).advance(SECOND // 10)
    assert len(samples) == 10
    whole, link = samples[-2:]
    assert (whole.topic, whole.frame_id, whole.child_frame_id) == ("/model/b/pose", "w", "b")
    assert whole.translation == pytest.approx((1, 2, 0.5), abs=1e-3)
    assert (link.frame_id, link.child_frame_id) == ("b", "b/link")
    assert link.translation == pytest.approx((0, 0, 0), abs=1e-9)


def test_gzs_pose_publisher_keeps_what_no_joint_moves_apart():
    link = "<link name='{}'><pose>{} 0 0.5 0 0 0</pose></link>"
    joint = (
        "<joint name='{0}{1}' type='{2}'><parent>{0}</parent><child>{1}</child><axis><xyz>0 0 1</xyz></axis></joint>"
    )
    links = link.format("a", 0) + link.format("wheel", 1) + link.format("eye", 2)
    joints = joint.format("a", "wheel", "revolute") + joint.format("a", "eye", "fixed")
    model = f"<model name='m'>{links}{joints}</model>"
    parameters = "<static_publisher>true</static_publisher><static_update_frequency>10</static_update_frequency>"
    parameters += "<update_frequency>50</update_frequency>"
    samples = Simulation(world(with_plugin(model, "gz-sim-pose-publisher-system", parameters))).advance(SECOND)
    moving = [sample for sample in samples if sample.topic == "/model/m/pose"]
    fixed = [sample for sample in samples if sample.topic == "/model/m/pose_static"]
    assert {sample.child_frame_id for sample in moving} == {"m/wheel"}
    assert {sample.child_frame_id for sample in fixed} == {"m/a", "m/eye"}
    assert (len(moving), len(fixed)) == (50, 20)
    assert fixed[-1].translation == pytest.approx((2, 0, 0.5), abs=1e-6)


def test_a_force_lasts_until_the_next_command():
    simulation = Simulation(
        world(with_plugin(box("b", "0 0 9 0 0 0"), "libgazebo_ros_force.so", "<link_name>link</link_name>"))
    )
    simulation.gravity = (0, 0, 0)
    simulation.command("/gazebo_ros_force", WrenchCommand(np.array((2.0, 0, 0))))
    simulation.advance(SECOND)
    assert simulation.velocity("b")[0][0] == pytest.approx(2.0, rel=0.01)
    simulation.command("/gazebo_ros_force", WrenchCommand())
    simulation.advance(SECOND)
    assert simulation.velocity("b")[0][0] == pytest.approx(2.0, rel=0.01)


def test_a_force_may_turn_with_the_link():
    parameters = "<link_name>link</link_name><force_frame>link</force_frame>"
    simulation = Simulation(world(with_plugin(box("b", "0 0 9 0 0 1.5707963"), "libgazebo_ros_force.so", parameters)))
    simulation.gravity = (0, 0, 0)
    simulation.command("/gazebo_ros_force", WrenchCommand(np.array((2.0, 0, 0))))
    simulation.advance(SECOND)
    assert simulation.velocity("b")[0] == pytest.approx((0, 2, 0), abs=0.02)


def gripper(extra=""):
    """Return a gripper of 5 kg that floats over a block of 1 kg."""
    model = box("hand", "0 0 1.06 0 0 0", "0.1 0.1 0.1", mass=5.0).replace(
        "<link name='link'>", "<link name='link'><gravity>false</gravity>"
    )
    parameters = f"<link_name>link</link_name><max_distance>0.1</max_distance>{extra}"
    return with_plugin(model, "libgazebo_ros_vacuum_gripper.so", parameters)


def test_a_vacuum_gripper_lifts_and_lets_go():
    table = box("table", "0 0 0.4 0 0 0", "1 1 0.8", static=True)
    simulation = Simulation(world(table, gripper(), box("thing", "0 0 0.9 0 0 0", "0.2 0.2 0.2")))
    simulation.advance(SECOND // 5)
    (switch,) = simulation.switches.values()
    switch.take(True)
    assert last(simulation.advance(SECOND // 5), FlagSample).value
    simulation.push("hand", force=(0, 0, 20.0), duration_ns=SECOND)
    simulation.advance(SECOND)
    lifted = simulation.pose("thing").position[2]
    assert lifted > 1.2
    assert simulation.pose("hand").position[2] - lifted == pytest.approx(0.16, abs=0.01)
    switch.take(False)
    simulation.advance(SECOND // 2)
    assert simulation.pose("thing").position[2] < lifted - 0.3


def test_a_gripper_holds_nothing_that_is_out_of_reach():
    simulation = Simulation(world(gripper(), box("thing", "0 0 0.1 0 0 0", "0.2 0.2 0.2")))
    simulation.switches["/switch"].take(True)
    assert not last(simulation.advance(SECOND // 5), FlagSample).value


def test_a_gripper_forgets_what_was_deleted():
    simulation = Simulation(world(gripper(), box("thing", "0 0 0.9 0 0 0", "0.2 0.2 0.2")))
    simulation.switches["/switch"].take(True)
    simulation.advance(SECOND // 100)
    simulation.delete("thing")
    assert not last(simulation.advance(SECOND // 2), FlagSample).value


ARM = (
    "<model name='arm'><link name='base'/><link name='rod'><inertial><pose>0.2 0 0 0 0 0</pose><mass>1</mass>"
    "<inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>"
    "<joint name='w' type='fixed'><parent>world</parent><child>base</child></joint>"
    "<joint name='j' type='revolute'><parent>base</parent><child>rod</child><axis><xyz>0 0 1</xyz></axis></joint>"
    "</model>"
)


@pytest.mark.parametrize(
    ("library", "topic"),
    [
        ("libgazebo_ros_joint_pose_trajectory.so", "/set_joint_trajectory"),
        ("gz-sim-joint-trajectory-controller-system", "/model/arm/joint_trajectory"),
    ],
)
def test_joints_follow_a_trajectory(library, topic):
    simulation = Simulation(world(with_plugin(ARM, library)))
    command = PositionTrajectoryCommand(("j",), np.array((0.0, 1.0, 2.0)), np.array(((0.0,), (1.0,), (0.5,))))
    assert simulation.command(topic, command) == 1
    simulation.advance(SECOND // 2)
    assert simulation.joint("arm", "j").position == pytest.approx(0.5, abs=0.01)
    simulation.advance(2 * SECOND)
    assert simulation.joint("arm", "j").position == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("names", ["", "<joint_name>j</joint_name>"])
def test_gzs_trajectory_controller_holds_the_start_and_the_end(names):
    parameters = f"{names}<initial_position>0.3</initial_position><position_p_gain>9</position_p_gain>"
    simulation = Simulation(world(with_plugin(ARM, "gz-sim-joint-trajectory-controller-system", parameters)))
    assert not simulation.warnings
    simulation.gravity = (0, -9.8, 0)  # across the arm, which turns about z
    simulation.advance(SECOND)
    assert simulation.joint("arm", "j").position == pytest.approx(0.3, abs=0.01)
    command = PositionTrajectoryCommand(("j",), np.array((0.5,)), np.array(((1.0,),)))
    simulation.command("/model/arm/joint_trajectory", command)
    simulation.advance(2 * SECOND)
    assert simulation.joint("arm", "j").position == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        (
            "<initial_position>0</initial_position><initial_position>1</initial_position>",
            "at most 1 <initial_position>",
        ),
    ],
)
def test_mistakes_of_gzs_trajectory_controller_are_named(parameters, words):
    with pytest.raises(DescriptionError, match=words):
        Simulation(world(with_plugin(ARM, "gz-sim-joint-trajectory-controller-system", parameters)))


def test_a_trajectory_of_unknown_joints_is_ignored_with_a_warning():
    said = []
    simulation = Simulation(world(with_plugin(ARM, "libgazebo_ros_joint_pose_trajectory.so")), warn=said.append)
    simulation.command("/set_joint_trajectory", PositionTrajectoryCommand(("k",), np.zeros(1), np.zeros((1, 1))))
    assert "no movable joint 'k'" in said[-1]


@pytest.mark.parametrize("kind", ["joint-position-controller", "joint-controller"])
def test_gzs_controllers_hold_a_joint(kind):
    parameters = "<joint_name>j</joint_name><topic>wanted</topic><p_gain>50</p_gain><d_gain>5</d_gain>"
    simulation = Simulation(world(with_plugin(ARM, f"gz-sim-{kind}-system", parameters)))
    simulation.command("/wanted", NumberCommand(0.7))
    simulation.advance(3 * SECOND)
    joint = simulation.joint("arm", "j")
    assert (joint.position if "position" in kind else joint.velocity) == pytest.approx(0.7, abs=0.01)


def test_gzs_joint_controller_may_have_several_joints():
    wheels = "".join(f"<joint_name>{wheel}_j</joint_name>" for wheel in ("fl", "fr", "rl", "rr"))
    drive = f"<plugin name='p' filename='gz-sim-joint-controller-system'>{wheels}</plugin>"
    simulation = Simulation(world(four_wheels(drive, radius=0.1)))
    simulation.command("/model/cart/joint/fl_j/cmd_vel", NumberCommand(3.0))
    simulation.advance(2 * SECOND)
    assert simulation.velocity("cart")[0][0] == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize(("limit", "reached"), [(20, True), (1, False)])
def test_gzs_position_controller_takes_what_gravity_pulls_away(limit, reached):
    parameters = "<joint_name>j</joint_name><topic>wanted</topic><p_gain>50</p_gain><d_gain>5</d_gain>"
    parameters += f"<i_gain>50</i_gain><i_max>{limit}</i_max><i_min>-{limit}</i_min>"
    simulation = Simulation(world(with_plugin(ARM, "gz-sim-joint-position-controller-system", parameters)))
    simulation.gravity = (0, -9.8, 0)  # across the arm, which turns about z
    simulation.advance(5 * SECOND)
    assert (abs(simulation.joint("arm", "j").position) < 0.005) is reached


def test_gzs_odometry_publisher_may_err():
    parameters = "<gaussian_noise>0.1</gaussian_noise>"
    model = with_plugin(box("b", "0 0 0.5 0 0 0"), "gz-sim-odometry-publisher-system", parameters)
    told = [s.position[0] for s in Simulation(world(model)).advance(5 * SECOND) if isinstance(s, OdometrySample)]
    assert np.std(told) == pytest.approx(0.1, rel=0.2)


@pytest.mark.parametrize("library", ["gazebo_ros_p3d", "gazebo_ros_force", "gazebo_ros_vacuum_gripper"])
def test_an_unknown_link_is_named(library):
    parameters = "<body_name>tail</body_name><link_name>tail</link_name><bodyName>tail</bodyName>"
    simulation = Simulation(world(with_plugin(box("b"), f"lib{library}.so", parameters)), warn=lambda line: None)
    assert "there is no link 'tail'" in simulation.warnings[0]


def test_an_unknown_plugin_is_named_and_the_rest_runs():
    said = []
    plugin = "<plugin name='odd' filename='libnobody_knows.so'/>"
    simulation = Simulation(world(plugin, with_plugin(box("b"), "libnor_this.so")), warn=said.append)
    simulation.advance(SECOND // 10)
    assert [line.split(": ", 1)[1] for line in said] == [
        "'odd': there is no simulator plugin 'nobody_knows' (left out)",
        "'p': there is no simulator plugin 'nor_this' (left out)",
    ]


def test_ros_1s_gps_tells_where_the_model_is_by_its_own_reference():
    """A hundred metres along x are a hundred metres in the direction of the heading, here east."""
    values = "<bodyName>link</bodyName><updateRate>10</updateRate><topicName>gps/fix</topicName><frameId>gps</frameId>"
    values += "<referenceLatitude>48</referenceLatitude><referenceLongitude>11</referenceLongitude>"
    values += "<referenceAltitude>500</referenceAltitude><referenceHeading>90</referenceHeading>"
    text = with_plugin(box("car", "100 10 0.1 0 0 0", "0.2 0.2 0.2"), "libhector_gazebo_ros_gps.so", values)
    fix = last(Simulation(world(text)).advance(SECOND // 5), NavSatSample)
    assert (fix.topic, fix.frame_id) == ("/gps/fix", "gps")
    # Radii of curvature of WGS 84 at 48 degrees.
    across, along = 6378137.0 / math.sqrt(1 - 0.00669438 * math.sin(math.radians(48)) ** 2), 6370_000.0
    assert fix.longitude - 11 == pytest.approx(math.degrees(100 / (across * math.cos(math.radians(48)))), rel=1e-3)
    assert fix.latitude - 48 == pytest.approx(math.degrees(10 / along), rel=2e-3)
    assert fix.altitude == pytest.approx(500.1, abs=0.01)
