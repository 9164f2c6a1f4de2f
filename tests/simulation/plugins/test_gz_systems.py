"""gz's systems for single models: efforts, thrusters, detachable joints, touch, batteries; and mimic joints."""

import math

import numpy as np
import pytest

from daidalos.description.errors import DescriptionError
from daidalos.samples.commands import NumberCommand, SignalCommand, TwistCommand
from daidalos.samples.sensors import (
    BatterySample,
    FlagSample,
    OdometrySample,
    TextSample,
)
from daidalos.simulation import Simulation
from simulation.models import box, world
from simulation.plugins.vehicles import four_wheels, inertia
from simulation.test_directional_friction import mecanum

SECOND = 1_000_000_000


def with_plugin(model, file, parameters=""):
    return model.replace("</model>", f"<plugin name='p' filename='{file}'>{parameters}</plugin></model>")


def slider(kind="prismatic", axis="1 0 0"):
    """Return a carriage of 2 kg on a rail in the world."""
    return (
        f"<model name='m'><link name='rail'/><link name='carriage'><pose>0 0 1 0 0 0</pose>{inertia(2, 0.5)}</link>"
        "<joint name='hold' type='fixed'><parent>world</parent><child>rail</child></joint>"
        f"<joint name='j' type='{kind}'><parent>rail</parent><child>carriage</child><axis><xyz>{axis}</xyz>"
        "<limit><lower>-100</lower><upper>100</upper></limit></axis></joint></model>"
    )


def weightless(*parts):
    simulation = Simulation(world(*parts))
    simulation.gravity = (0.0, 0.0, 0.0)
    return simulation


def test_an_effort_on_a_joint_lasts():
    simulation = weightless(with_plugin(slider(), "gz-sim-apply-joint-force-system", "<joint_name>j</joint_name>"))
    simulation.command("/model/m/joint/j/cmd_force", NumberCommand(3.0))
    simulation.advance(SECOND)
    assert simulation.joint("m", "j").velocity == pytest.approx(1.5, rel=0.01)
    simulation.reset()
    simulation.advance(SECOND)
    assert simulation.joint("m", "j").velocity == pytest.approx(0.0, abs=1e-6)


def test_a_thruster_pushes_along_its_axis():
    propeller = (
        f"<model name='m'><link name='hull'><pose>0 0 9 0 0 1.5707963</pose>{inertia(1.5, 1)}</link><link name='screw'>"
        f"<pose relative_to='hull'>0 0 0 0 0 0</pose>{inertia(0.5, 0.01)}</link><joint name='j' type='revolute'>"
        "<parent>hull</parent><child>screw</child><axis><xyz>1 0 0</xyz></axis></joint></model>"
    )
    sizes = "<joint_name>j</joint_name><thrust_coefficient>0.5</thrust_coefficient><fluid_density>1000</fluid_density>"
    sizes += "<propeller_diameter>0.1</propeller_diameter><max_thrust_cmd>6</max_thrust_cmd>"
    for extra, topic, command, thrust in (
        ("", "joint/j/cmd_thrust", 4.0, 4.0),
        ("", "joint/j/cmd_thrust", 100.0, 6.0),
        ("<use_angvel_cmd>true</use_angvel_cmd>", "joint/j/cmd_vel", -10.0, -5.0),
        ("<topic>push</topic>", "push", 1.0, 1.0),
    ):
        simulation = weightless(with_plugin(propeller, "gz-sim-thruster-system", sizes + extra))
        assert simulation.command(f"/model/m/{topic}", NumberCommand(command)) == 1
        simulation.advance(SECOND)
        assert simulation.velocity("m")[0] == pytest.approx((0, thrust / 2, 0), abs=0.02)


@pytest.mark.parametrize("masses", [(1, 1), (1, 100), (100, 1)])
def test_a_detachable_joint_is_rigid_whatever_it_holds(masses):
    holder, held = masses
    parameters = "<parent_link>link</parent_link><child_model>held</child_model><child_link>link</child_link>"
    parts = with_plugin(box("holder", "0 0 3 0 0 0", mass=holder), "gz-sim-detachable-joint-system", parameters)
    simulation = Simulation(world(parts, box("held", "0 2 3 0 0 0", mass=held)))
    simulation.step()
    simulation.set_velocity("held", (2, 0, 0), (0, 0, 0))
    for _ in range(10):
        simulation.advance(SECOND // 10)
        place = simulation.pose("holder").inverse @ simulation.pose("held")
        assert place.position == pytest.approx((0, 2, 0), abs=5e-3)
    simulation.delete("held")
    simulation.advance(SECOND // 10)


def test_a_detachable_joint_holds_until_it_is_told_to_let_go():
    stand = box("stand", "0 0 2 0 0 0", "0.1 0.1 0.1", static=True)
    parameters = "<parent_link>link</parent_link><child_model>load</child_model><child_link>link</child_link>"
    stand = with_plugin(stand, "gz-sim-detachable-joint-system", parameters + "<detach_topic>/drop</detach_topic>")
    simulation = Simulation(world(stand, box("load", "0 0 1 0 0 0", "0.2 0.2 0.2")))
    samples = simulation.advance(SECOND)
    assert [s.text for s in samples if isinstance(s, TextSample)] == ["attached"]
    assert simulation.pose("load").position[2] == pytest.approx(1.0, abs=0.01)
    simulation.command("/drop", SignalCommand())
    samples = simulation.advance(SECOND)
    assert [s.text for s in samples if isinstance(s, TextSample)] == ["detached"]
    assert simulation.pose("load").position[2] == pytest.approx(0.1, abs=0.01)
    simulation.command("/model/stand/detachable_joint/attach", SignalCommand())
    simulation.set_pose("stand", simulation.pose("stand"))
    simulation.advance(SECOND // 2)
    assert simulation.pose("load").position[2] == pytest.approx(0.1, abs=0.01)  # where it was taken


def test_touch_is_told_once():
    parameters = "<target>ground</target><namespace>landing</namespace><time>0.5</time><enabled>true</enabled>"
    model = with_plugin(box("b", "0 0 0.52 0 0 0"), "gz-sim-touchplugin-system", parameters)
    simulation = Simulation(world(model))
    flags = [s for s in simulation.advance(3 * SECOND) if isinstance(s, FlagSample)]
    assert [(one.topic, one.value) for one in flags] == [("/landing/touched", True)]
    assert flags[0].stamp_ns * 1e-9 == pytest.approx(math.sqrt(2 * 0.02 / 9.8) + 0.5, abs=0.05)
    simulation.switches["/landing/enable"].take(True)
    assert sum(isinstance(s, FlagSample) for s in simulation.advance(SECOND)) == 1


def test_the_models_name_stands_for_a_missing_namespace():
    plugin = with_plugin(box("b"), "gz-sim-touchplugin-system", "<target>ground</target><enabled>true</enabled>")
    assert "/b/touched" in Simulation(world(plugin)).publications


def test_a_battery_empties_under_its_load():
    parameters = (
        "<battery_name>cell</battery_name><voltage>12</voltage><initial_charge>0.5</initial_charge>"
        "<open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef><power_load>36</power_load>"
        "<open_circuit_voltage_linear_coef>-4</open_circuit_voltage_linear_coef><capacity>1</capacity>"
        "<resistance>0.1</resistance><smooth_current_tau>0.01</smooth_current_tau>"
        "<enable_recharge>true</enable_recharge><charging_time>0.5</charging_time>"
        "<power_draining_topic>/go</power_draining_topic>"
    )
    model = with_plugin(box("b"), "gz-sim-linearbatteryplugin-system", parameters)
    simulation = Simulation(world(model))
    rest = [s for s in simulation.advance(SECOND) if isinstance(s, BatterySample)][-1]
    assert (rest.topic, rest.voltage, rest.current) == ("/model/b/battery/cell/state", pytest.approx(10.0), 0.0)
    simulation.command("/go", SignalCommand())
    under = [s for s in simulation.advance(10 * SECOND) if isinstance(s, BatterySample)][-1]
    # 36 W = i (10 - 0.1 i), less a little charge
    assert under.current == pytest.approx(-(100 - math.sqrt(100**2 - 4 * 360)) / 2, rel=0.01)
    assert under.charge == pytest.approx(0.5 + under.current * 10 / 3600, rel=1e-3)
    simulation.switches["/model/b/battery/cell/recharge/start"].take(True)
    charged = [s for s in simulation.advance(10 * SECOND) if isinstance(s, BatterySample)][-1]
    assert charged.current == pytest.approx(2.0 + under.current, abs=0.1)


@pytest.mark.slow
def test_gzs_mecanum_drive_goes_sideways_and_knows_it():
    model = mecanum(drives=False)
    names = {"front_left": "fl_j", "front_right": "fr_j", "back_left": "rl_j", "back_right": "rr_j"}
    parameters = "".join(f"<{place}_joint>{joint}</{place}_joint>" for place, joint in names.items())
    parameters += "<wheel_separation>0.5</wheel_separation><wheelbase>0.6</wheelbase><wheel_radius>0.1</wheel_radius>"
    simulation = Simulation(world(with_plugin(model, "gz-sim-mecanum-drive-system", parameters)))
    start = simulation.pose("cart")
    simulation.command("/model/cart/cmd_vel", TwistCommand(np.array((0.2, 0.3, 0.0)), np.array((0.0, 0.0, 0.4))))
    odometry = [s for s in simulation.advance(2 * SECOND) if isinstance(s, OdometrySample)][-1]
    moved = start.inverse @ simulation.pose("cart")
    assert moved.position[:2] == pytest.approx(odometry.position[:2], abs=0.03)
    assert moved.yaw == pytest.approx(0.8, abs=0.05)
    assert odometry.linear[:2] == pytest.approx((0.2, 0.3), abs=0.01)


def test_a_mimic_plugin_ties_joints():
    parameters = "<joint>fl_j</joint><mimicJoint>fr_j</mimicJoint><multiplier>-0.5</multiplier><hasPID/>"
    turn = "<plugin name='t' filename='gz-sim-joint-controller-system'><joint_name>fl_j</joint_name></plugin>"
    cart = four_wheels(turn).replace("<model name='cart'>", "<model name='cart'><pose>0 0 1 0 0 0</pose>")
    simulation = weightless(with_plugin(cart, "libroboticsgroup_gazebo_mimic_joint_plugin.so", parameters))
    simulation.command("/model/cart/joint/fl_j/cmd_vel", NumberCommand(1.0))
    simulation.advance(SECOND)
    leader, follower = (simulation.joint("cart", name).position for name in ("fl_j", "fr_j"))
    assert leader > 0.8
    assert follower == pytest.approx(-0.5 * leader, abs=0.01)
    assert not simulation.warnings


@pytest.mark.parametrize(
    ("file", "parameters", "words"),
    [
        ("gz-sim-thruster-system", "<joint_name>fl_j</joint_name><min_thrust_cmd>9e9</min_thrust_cmd>", "is above"),
        (
            "gz-sim-detachable-joint-system",
            "<parent_link>fl</parent_link>",
            "<child_model> and <child_link> are needed",
        ),
        ("gz-sim-touchplugin-system", "<namespace>a</namespace>", "<target> is needed"),
        ("gz-sim-linearbatteryplugin-system", "", "<battery_name> is needed"),
    ],
)
def test_wrong_parameters_are_named(file, parameters, words):
    with pytest.raises(DescriptionError, match=f"^w.sdf:1: .*{words}"):
        Simulation(world(with_plugin(four_wheels(""), file, parameters)))


@pytest.mark.parametrize(
    ("file", "parameters", "words"),
    [
        ("gz-sim-apply-joint-force-system", "<joint_name>nose</joint_name>", "there is no joint 'nose'"),
        ("gz-sim-detachable-joint-system", "<parent_link>nose</parent_link>", "there is no link 'nose'"),
        ("gz-sim-mecanum-drive-system", "", "<front_left_joint> is missing"),
        ("gz-sim-joint-controller-system", "<joint_name>fl_jj</joint_name>", "did you mean 'fl_j'"),
    ],
)
def test_a_plugin_for_an_absent_part_is_left_out(file, parameters, words):
    simulation = Simulation(world(with_plugin(four_wheels(""), file, parameters)), warn=lambda line: None)
    assert words in simulation.warnings[0]
    assert simulation.warnings[0].startswith("w.sdf:1: ")
    assert simulation.warnings[0].endswith("; the plugin is left out")
    simulation.step(10)


def test_a_drive_of_a_static_model_is_left_out():
    drive = "<left_joint>fl_j</left_joint><right_joint>fr_j</right_joint>"
    cart = with_plugin(four_wheels(""), "gz-sim-diff-drive-system", drive).replace(">", "><static>1</static>", 1)
    simulation = Simulation(world(cart), warn=lambda line: None)
    assert "joint 'fl_j' can not move, as model 'cart' is static" in simulation.warnings[0]
