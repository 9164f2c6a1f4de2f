import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf, urdf
from daidalos.description.errors import DescriptionError
from daidalos.description.link import Inertial
from daidalos.samples.commands import TwistCommand
from daidalos.samples.sensors import ImuSample, LaserScanSample, OdometrySample
from daidalos.simulation import Simulation
from daidalos.simulation.errors import NameTakenError, SimulationError, UnknownNameError
from simulation.models import arena, box, turtlebot, world

SECOND = 1_000_000_000
AHEAD = TwistCommand(np.array([0.2, 0, 0]), np.array([0, 0, 0.3]))


def numbers(samples):
    """All numbers in samples, to compare two runs bit for bit."""
    return [
        (
            type(s).__name__,
            s.topic,
            *(np.asarray(v).tobytes() for v in vars(s).values() if not isinstance(v, str)),
        )
        for s in samples
    ]


def test_a_dropped_box_falls_by_the_book():
    simulation = Simulation(world(box("b", "0 0 5 0 0 0")))
    simulation.advance(SECOND // 2)
    assert simulation.time_ns == SECOND // 2
    height = simulation.pose("b").position[2]
    assert height == pytest.approx(5 - 9.8 / 2 * 0.25, abs=0.01)
    linear, angular = simulation.velocity("b")
    assert linear == pytest.approx([0, 0, -4.9], abs=1e-6)
    assert angular == pytest.approx([0, 0, 0])


def test_a_box_at_rest_stays():
    simulation = Simulation(world(box("b")))
    simulation.advance(10 * SECOND)
    assert simulation.pose("b").position == pytest.approx((0, 0, 0.5), abs=1e-3)


@pytest.mark.parametrize(("angle", "slides"), [(0.35, False), (0.45, True)])
def test_friction_holds_up_to_its_angle(angle, slides):
    """A ramp and a box with mu 0.4 and 100: the smaller one counts, its angle is 0.38 rad."""
    ramp = box("ramp", f"0 0 0 0 {angle} 0", "20 2 0.1", static=True, surface=friction(100))
    load = box("load", f"0 0 0 0 {angle} 0", "0.4 0.4 0.2", surface=friction(0.4))
    simulation = Simulation(sdf.parse(f"<sdf version='1.9'><world name='w'>{ramp}{load}</world></sdf>"))
    simulation.set_pose("load", Pose.from_xyz_rpy((0, 0, 0), (0, angle, 0)) @ Pose((0, 0, 0.15)))
    simulation.advance(SECOND)
    start = simulation.pose("load").position[0]
    simulation.advance(SECOND)
    moved = simulation.pose("load").position[0] - start
    if slides:
        down = 9.8 * (np.sin(angle) - 0.4 * np.cos(angle))
        assert moved == pytest.approx(1.5 * down * np.cos(angle), rel=0.05)
    else:
        assert abs(moved) < 0.01


def friction(mu):
    return f"<surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction></surface>"


def test_static_models_collide_where_they_were_moved_to():
    simulation = Simulation(world(box("table", "5 0 0.5 0 0 0", static=True)))
    simulation.set_pose("table", Pose((0, 0, 0.5)))
    simulation.spawn(sdf.parse_model(f"<sdf version='1.9'>{box('b', '0 0 1.6 0 0 0')}</sdf>"))
    simulation.advance(2 * SECOND)
    assert simulation.pose("b").position == pytest.approx((0, 0, 1.5), abs=1e-2)
    assert simulation.pose("table").position == (0, 0, 0.5)


def test_what_sleeps_wakes_when_its_table_goes():
    table, cup = box("table", static=True), box("cup", "0 0 1.1 0 0 0", "0.2 0.2 0.2")
    for change in (lambda s: s.set_pose("table", Pose((5, 0, 0.5))), lambda s: s.delete("table")):
        simulation = Simulation(world(table, cup))
        simulation.advance(3 * SECOND)
        assert simulation.physics.data.ntree_awake == 0
        assert simulation.pose("cup").position[2] == pytest.approx(1.1, abs=1e-3)
        change(simulation)
        simulation.advance(SECOND)
        assert simulation.pose("cup").position[2] == pytest.approx(0.1, abs=1e-2)


def test_what_sleeps_wakes_when_it_is_pushed():
    simulation = Simulation(world(box("a"), box("b", "3 0 0.5 0 0 0")))
    simulation.advance(3 * SECOND)
    assert simulation.physics.data.ntree_awake == 0
    simulation.set_velocity("a", (8, 0, 0), (0, 0, 0))
    simulation.advance(SECOND)
    assert simulation.pose("b").position[0] > 3.1


def test_states_with_sleepers_replay_bit_for_bit():
    simulation = Simulation(world(box("a"), box("b", "3 0 0.5 0 0 0")))
    simulation.advance(3 * SECOND)
    simulation.set_velocity("a", (8, 0, 0), (0, 0, 0))
    state = simulation.save()
    ends = []
    for _ in range(2):
        simulation.restore(state)
        simulation.advance(SECOND)
        ends.append([simulation.pose(name) for name in "ab"])
    assert ends[0] == ends[1]


def test_spawning_and_deleting_keep_the_state_of_the_others():
    lonely, busy = Simulation(world(box("a", "0 0 3 0 0 0"))), Simulation(world(box("a", "0 0 3 0 0 0")))
    other = sdf.parse_model(f"<sdf version='1.9'>{box('b', '5 0 4 0 0 0')}</sdf>")
    for simulation in (lonely, busy):
        simulation.advance(SECOND // 4)
    busy.spawn(other, "b")
    for simulation in (lonely, busy):
        simulation.advance(SECOND // 4)
    assert busy.models == ("ground_plane", "a", "b")
    busy.delete("b")
    assert busy.models == ("ground_plane", "a")
    for simulation in (lonely, busy):
        simulation.advance(SECOND // 4)
    assert busy.time_ns == 3 * SECOND // 4
    assert busy.pose("a").position == pytest.approx(lonely.pose("a").position, abs=1e-12)


def test_spawn_takes_name_and_pose():
    simulation = Simulation(world())
    model = sdf.parse_model(f"<sdf version='1.9'>{box('b', '1 2 3 0 0 0')}</sdf>")
    assert simulation.spawn(model) == "b"
    simulation.spawn(model, "c", Pose((4, 5, 6)))
    assert simulation.pose("b") == Pose((1, 2, 3))
    assert simulation.pose("c", "link") == Pose((4, 5, 6))
    with pytest.raises(NameTakenError, match="a model 'b' is in the simulation already"):
        simulation.spawn(model)
    with pytest.raises(UnknownNameError, match="no model 'd'; known are ground_plane, b, c"):
        simulation.delete("d")
    with pytest.raises(UnknownNameError, match="no link 'x'; known are link"):
        simulation.pose("b", "x")


@pytest.mark.slow
def test_many_models_come_and_go_without_a_trace():
    simulation = Simulation(world())
    before = (
        simulation.physics.model.nbody,
        len(simulation._compilation.spec.bodies),
        len(simulation._compilation.spec.frames),
    )
    for number in range(30):
        simulation.spawn(turtlebot(), f"r{number}", Pose((number, 0, 0)), namespace=f"r{number}")
        simulation.step()
        simulation.delete(f"r{number}")
    after = (
        simulation.physics.model.nbody,
        len(simulation._compilation.spec.bodies),
        len(simulation._compilation.spec.frames),
    )
    assert after == before
    assert not simulation._compilation.spec.actuators
    assert not simulation._compilation.spec.excludes
    assert not simulation.publications


@pytest.mark.parametrize("heading", [0.0, 1.0])
def test_a_failed_spawn_leaves_the_world_as_it_was(heading):
    simulation = Simulation(world(box("a", f"0 0 3 0 0 {heading}")))
    fixed = "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/>"
    fixed += "<child link='b'/></joint>{}</robot>"
    narrow = "<gazebo><plugin name='d' filename='libgazebo_ros_p3d.so'><update_rate>x</update_rate></plugin></gazebo>"
    with pytest.raises(DescriptionError, match="should be a number, got 'x'"):
        simulation.spawn(urdf.parse(fixed.format(narrow)))
    loose = "<gazebo><plugin name='d' filename='libgazebo_ros_diff_drive.so'>{}</plugin></gazebo>"
    wheels = "<left_joint>{0}</left_joint><right_joint>{0}</right_joint>"
    for number, (parameters, words) in enumerate(
        (
            ("", "<left_joint> is missing"),
            (wheels.format("k"), "there is no joint 'k'"),
            (wheels.format("j"), "joint 'j' is fixed, expected one with an axis"),
        )
    ):
        simulation.spawn(urdf.parse(fixed.format(loose.format(parameters))), f"r{number}")
        assert words in simulation.warnings[-1]
        simulation.delete(f"r{number}")
    assert simulation.models == ("ground_plane", "a")
    simulation.spawn(urdf.parse(fixed.format("")))
    simulation.advance(SECOND // 10)


@pytest.mark.slow
@pytest.mark.parametrize("moved", [False, True])
def test_a_robot_that_is_placed_inside_another_leaves_it_slowly(moved):
    simulation = Simulation(world())
    for name, x in (("a", 0.0), ("b", 3.0 if moved else 0.02)):
        simulation.spawn(turtlebot(), name, Pose((x, 0, 0)), name)
    if moved:
        simulation.advance(SECOND // 10)
        simulation.set_pose("b", Pose((0.02, 0, 0)))
    odometry = [sample for sample in simulation.advance(3 * SECOND) if isinstance(sample, OdometrySample)]
    assert max(abs(sample.linear[0]) for sample in odometry) < 1.5
    assert max(abs(sample.angular[2]) for sample in odometry) < 5.0


def test_contacts_are_stiff_again_when_a_placed_thing_is_free():
    simulation = Simulation(world(box("a"), box("b", "3 0 0.5 0 0 0")))
    stiff = simulation.physics.model.geom_solref.copy()
    simulation.set_pose("b", Pose((0.9, 0, 0.5)))
    assert (simulation.physics.model.geom_solref != stiff).any()
    fastest = 0.0
    for _ in range(50):
        simulation.advance(SECOND // 25)
        fastest = max(fastest, float(np.abs(simulation.velocity("b")[0]).max()))
    assert 0.01 < fastest < 1.0
    gap = simulation.pose("b").position[0] - simulation.pose("a").position[0]
    assert gap == pytest.approx(1.0, abs=0.1)
    assert (simulation.physics.model.geom_solref == stiff).all()


def test_heavy_things_on_light_ones_do_not_sink():
    parts = box("light", "0 0 0.05 0 0 0", "0.1 0.1 0.1", mass=0.1), box("heavy", "0 0 0.6 0 0 0", mass=1000)
    simulation = Simulation(world(*parts))
    simulation.advance(2 * SECOND)
    assert simulation.pose("heavy").position[2] == pytest.approx(0.6, abs=2e-3)


def test_a_box_without_restitution_stays_where_it_falls():
    """From 1 m: it leaves the ground with less than 6 % of its speed, so it rises by less than 4 mm."""
    simulation = Simulation(world(box("a", "0 0 1.5 0 0 0")))
    heights = []
    for _ in range(500):
        simulation.step(2)
        heights.append(simulation.pose("a").position[2] - 0.5)
    lowest = heights.index(min(heights))
    assert max(heights[lowest:]) < 4e-3


@pytest.mark.slow
def test_the_same_seed_gives_the_same_run():
    def run(seed):
        simulation = Simulation(arena(), seed=seed)
        simulation.spawn(turtlebot(noise=True), "robot")
        simulation.command("/cmd_vel", AHEAD)
        return numbers(simulation.advance(2 * SECOND))

    first = run(7)
    assert run(7) == first
    assert run(8) != first


@pytest.mark.slow
def test_slices_of_time_add_up():
    def run(slices):
        simulation = Simulation(arena(), seed=1)
        simulation.spawn(turtlebot(noise=True), "robot")
        return numbers([s for duration in slices for s in simulation.advance(duration)])

    assert run([SECOND]) == run([SECOND // 60] * 60 + [SECOND - SECOND // 60 * 60])


def test_noise_does_not_depend_on_who_else_is_there():
    def imu(*names):
        simulation = Simulation(world(), seed=3)
        for number, name in enumerate(names):
            simulation.spawn(turtlebot(noise=True), name, Pose((2 * number, 0, 0)), namespace=name)
        samples = simulation.advance(SECOND // 10)
        return [s.angular_velocity[2] for s in samples if isinstance(s, ImuSample) and s.topic == "/b/imu"]

    np.testing.assert_allclose(imu("b"), imu("a", "b"), atol=1e-9)


def test_samples_come_in_order_and_at_their_rates():
    simulation = Simulation(arena())
    simulation.spawn(turtlebot(), "robot")
    samples = simulation.advance(2 * SECOND)
    stamps = [sample.stamp_ns for sample in samples]
    assert stamps == sorted(stamps)
    counts = {topic: sum(s.topic == topic for s in samples) for topic in simulation.publications}
    assert counts == {"/scan": 30, "/imu": 400, "/odom": 200, "/tf": 200, "/joint_states": 200}


def test_a_namespace_keeps_robots_apart():
    simulation = Simulation(world())
    for name, x in (("one", 0), ("two", 3)):
        simulation.spawn(turtlebot(), name, Pose((x, 0, 0)), namespace=name)
    assert {"/one/scan", "/two/scan", "/one/odom", "/two/imu", "/tf"} <= set(simulation.publications)
    assert set(simulation.subscriptions) == {"/one/cmd_vel", "/two/cmd_vel"}
    assert simulation.command("/one/cmd_vel", AHEAD) == 1
    assert simulation.command("/nobody", AHEAD) == 0
    simulation.advance(SECOND)
    assert simulation.pose("one").position[0] > 0.1
    assert simulation.pose("two").position[0] == pytest.approx(3, abs=1e-3)
    with pytest.raises(TypeError, match="takes TwistCommand, got int"):
        simulation.command("/one/cmd_vel", 3)


def test_sensors_nobody_hears_do_not_measure():
    simulation = Simulation(arena(), has_subscribers=lambda topic: topic != "/scan")
    simulation.spawn(turtlebot(), "robot")
    samples = simulation.advance(SECOND)
    assert not any(isinstance(s, LaserScanSample) for s in samples)
    assert any(isinstance(s, ImuSample) for s in samples)


@pytest.mark.slow
def test_saved_states_replay_bit_for_bit():
    simulation = Simulation(arena(), seed=5)
    simulation.spawn(turtlebot(noise=True), "robot")
    simulation.command("/cmd_vel", AHEAD)
    simulation.advance(SECOND)
    state = simulation.save()
    first = numbers(simulation.advance(SECOND))
    simulation.restore(state)
    assert simulation.time_ns == SECOND
    assert numbers(simulation.advance(SECOND)) == first
    simulation.delete("robot")
    with pytest.raises(SimulationError, match="models were added or removed"):
        simulation.restore(state)


def test_states_outlive_changes_of_friction_and_mass():
    simulation = Simulation(world(box("crate", "0 0 2 0 0 0")))
    simulation.advance(100_000_000)
    state, height = simulation.save(), simulation.pose("crate").position[2]
    simulation.set_friction("crate", 0.2)
    simulation.set_link_properties("crate", "link", Inertial(5.0, inertia=(0.8, 0.0, 0.0, 0.8, 0.0, 0.8)), True)
    simulation.advance(1_000_000_000)
    simulation.restore(state)
    assert simulation.time_ns == 100_000_000
    assert simulation.pose("crate").position[2] == height
    simulation.advance(1_000_000)
    assert simulation.velocity("crate")[0][2] == pytest.approx(-9.8 * 0.101, rel=1e-3)
    simulation.delete("crate")
    simulation.spawn(sdf.parse_model(f"<sdf version='1.9'>{box('crate')}</sdf>"), "crate")
    with pytest.raises(SimulationError, match="models were added or removed"):
        simulation.restore(state)


@pytest.mark.slow
def test_reset_starts_over():
    simulation = Simulation(arena(), seed=5)
    simulation.spawn(turtlebot(noise=True), "robot")
    first = numbers(simulation.advance(SECOND))
    simulation.command("/cmd_vel", AHEAD)
    simulation.advance(SECOND)
    simulation.reset()
    assert simulation.time_ns == 0
    assert numbers(simulation.advance(SECOND)) == first


def test_set_velocity_moves_models():
    simulation = Simulation(sdf.parse("<sdf version='1.9'><world name='w'><gravity>0 0 0</gravity>"
                                      f"{box('b', '0 0 5 0 0 1')}</world></sdf>"))  # fmt: skip
    simulation.set_velocity("b", (1, 0, 0), (0, 0, 0.5))
    simulation.advance(SECOND)
    pose = simulation.pose("b")
    assert pose.position == pytest.approx((1, 0, 5), abs=1e-6)
    assert pose.yaw == pytest.approx(1.5, abs=1e-6)


def test_what_is_not_known_is_named_and_the_rest_runs():
    lines = []
    imu = "<sensor name='i' type='imu'><plugin name='x' filename='libx.so'/></sensor>"
    extra = f"<sensor name='nose' type='smell'/>{imu}"
    text = box("b", extra=extra).replace("</model>", "<plugin name='magic' filename='libmagic.so'/></model>")
    simulation = Simulation(world(text), warn=lines.append)
    assert simulation.warnings == lines
    assert [line.partition(": ")[2] for line in lines] == [
        "'magic': there is no simulator plugin 'magic' (left out)",
        "'nose': there is no sensor 'smell' (left out)",
        "'x': there is no simulator plugin 'x' (left out)",
    ]
    assert any(isinstance(s, ImuSample) for s in simulation.step())


def test_plugins_of_a_model_without_links_are_left_out():
    plugins = (
        "<plugin name='p' filename='libgazebo_ros_planar_move.so'/><plugin name='q' filename='gz-sim-imu-system'/>"
    )
    simulation = Simulation(world(f"<model name='empty'>{plugins}</model>"))
    assert [line.partition(": ")[2] for line in simulation.warnings] == ["plugin 'p' has no links, left out"]


def test_what_the_simulator_does_by_itself_is_no_unknown_plugin():
    names = ("libgazebo_ros_init.so", "gz-sim-physics-system", "libignition-gazebo-sensors-system.so")
    plugins = "".join(f"<plugin name='p' filename='{name}'/>" for name in names)
    assert not Simulation(world(box("b").replace("</model>", f"{plugins}</model>"))).warnings


def test_physics_that_diverge_say_so():
    simulation = Simulation(world(box("b", "0 0 3 0 0 0")))
    simulation.physics.data.qvel[0] = np.nan
    with pytest.raises(SimulationError, match=r"diverged at 0.001 s, first in b::link"):
        simulation.step()


def test_long_steps_are_cut():
    physics = "<physics type='ode'><max_step_size>0.01</max_step_size></physics>"
    simulation = Simulation(world(physics, box("b")))
    assert simulation.step_ns == 10_000_000
    simulation.step()
    assert simulation.time_ns == 10_000_000
    simulation.advance(10 * SECOND)
    assert simulation.pose("b").position == pytest.approx((0, 0, 0.5), abs=1e-3)


def test_an_empty_world_runs():
    simulation = Simulation()
    assert simulation.advance(SECOND) == []
    assert simulation.time_ns == SECOND


@pytest.mark.slow
def test_two_hundred_models_leave_nothing_behind():
    """Meshes, geoms, excludes and memory are as before once everything that came has gone."""
    import gc
    import resource

    simulation = Simulation(world())
    robot = turtlebot()

    def come_and_go(count):
        for number in range(count):
            simulation.spawn(robot, f"r{number}", Pose((0.0, 0.0, 1.0 + number)))
            simulation.step()
            simulation.delete(f"r{number}")
        gc.collect()

    come_and_go(20)
    model = simulation.physics.model
    before = (model.nbody, model.ngeom, model.nmesh, model.nexclude, model.nu, len(simulation._schedule._queue))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    come_and_go(200)
    model = simulation.physics.model
    after = (model.nbody, model.ngeom, model.nmesh, model.nexclude, model.nu, len(simulation._schedule._queue))
    assert after == before
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory < 20_000  # [KiB]


def test_a_divergence_writes_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    simulation = Simulation(world(box("b")))
    simulation.push("b", force=(1e30, 0, 0))
    with pytest.raises(SimulationError, match="diverged"):
        simulation.advance(1_000_000_000)
    assert not list(tmp_path.iterdir())


def simple(name, mass=1.0):
    return sdf.parse_model(f"<sdf version='1.9'>{box(name, mass=mass)}</sdf>")


def test_simple_models_are_compiled_together_when_the_world_is_used():
    simulation = Simulation(world())
    simulation.step(10)
    compiled = simulation._compilation.number
    for number in range(5):
        simulation.spawn(simple(f"b{number}"), f"b{number}", Pose((2.0 * number, 0.0, 3.0)))
    assert simulation._compilation.number == compiled
    assert simulation.models[-5:] == ("b0", "b1", "b2", "b3", "b4")
    simulation.delete("b1")
    simulation.step(100)
    assert simulation.pose("b4").position[:2] == pytest.approx((8.0, 0.0))
    assert simulation.pose("b4").position[2] == pytest.approx(3.0 - 9.8 / 2 * 0.1**2, abs=1e-3)
    with pytest.raises(UnknownNameError):
        simulation.instance("b1")


def test_it_is_the_same_whether_models_are_compiled_together_or_one_by_one():
    poses = []
    for together in (True, False):
        simulation = Simulation(world(), seed=1)
        for number in range(3):
            simulation.spawn(simple(f"b{number}"), f"b{number}", Pose((0.3 * number, 0.0, 1.0 + 1.5 * number)))
            if not together:
                assert simulation.pose(f"b{number}").position[0] == pytest.approx(0.3 * number)
        simulation.step(1000)
        poses.append([simulation.pose(f"b{number}") for number in range(3)])
    assert poses[0] == poses[1]


def test_a_state_from_before_waiting_models_is_refused():
    simulation = Simulation(world())
    state = simulation.save()
    simulation.spawn(simple("b"), "b")
    with pytest.raises(SimulationError, match="models were added"):
        simulation.restore(state)


def test_a_simple_model_that_can_not_be_simulated_is_refused_at_once():
    simulation = Simulation(world())
    simulation.spawn(simple("b"), "b")
    with pytest.raises(SimulationError, match="'light' cannot be simulated"):
        simulation.spawn(simple("light", mass=1e-17), "light")
    simulation.step(10)
    assert "light" not in simulation.models
    assert simulation.pose("b").position[2] == pytest.approx(0.5, abs=1e-3)
