"""The services and the action that every simulator may offer."""

import time
from threading import Event

import pytest
import trimesh
from action_msgs.msg import GoalStatus
from daidalos_msgs.srv import GetShapes
from geometry_msgs.msg import Point, Pose, PoseStamped, Twist, Vector3, Wrench
from rclpy.action import ActionClient
from ros_gz_interfaces.msg import Entity, EntityFactory, EntityWrench, WorldControl
from ros_gz_interfaces.srv import ControlWorld, DeleteEntity, SetEntityPose, SpawnEntity
from simulation_interfaces import srv
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import (
    Bounds,
    EntityCategory,
    EntityFilters,
    EntityInfo,
    EntityState,
    Resource,
    Result,
    SimulationState,
)

from daidalos.nodes.gazebo_ros._descriptions import read_world, wanted_speed
from nodes.gazebo_ros.conftest import BOX, WORLD

OK = Result.RESULT_OK
LAMP = """<sdf version="1.6"><model name="lamp"><link name="link"><visual name="v"><geometry><mesh>
<uri>meshes/lamp.stl</uri></mesh></geometry></visual></link></model></sdf>"""


def ask(shop, kind, name, /, **fields):
    return shop.call(kind, f"/gazebo/{name}", **fields)


def spawn(shop, name="crate", z=0.5, **fields):
    pose = PoseStamped(pose=Pose(position=Point(z=z)))
    resource = fields.pop("resource", Resource(resource_string=BOX))
    kind = srv.SpawnEntity
    return ask(shop, kind, "spawn_entity", name=name, entity_resource=resource, initial_pose=pose, **fields)


def test_entities_are_spawned_by_text_or_file(shop, tmp_path):
    assert spawn(shop).result.result == OK
    assert spawn(shop).result.result == srv.SpawnEntity.Response.NAME_NOT_UNIQUE
    renamed = spawn(shop, allow_renaming=True)
    assert (renamed.result.result, renamed.entity_name) == (OK, "crate_0")
    (tmp_path / "box.sdf").write_text(BOX)
    assert spawn(shop, "filed", resource=Resource(uri=str(tmp_path / "box.sdf"))).result.result == OK
    assert (
        spawn(shop, "none", resource=Resource(uri="nowhere.sdf")).result.result == srv.SpawnEntity.Response.NO_RESOURCE
    )
    broken = spawn(shop, "broken", resource=Resource(resource_string="<sdf"))
    assert broken.result.result == srv.SpawnEntity.Response.RESOURCE_PARSE_ERROR
    assert broken.result.error_message


def test_models_and_robots_to_spawn_are_listed(shop, tmp_path, monkeypatch):
    (tmp_path / "lamp" / "meshes").mkdir(parents=True)
    trimesh.creation.box((0.2, 0.2, 0.2)).export(tmp_path / "lamp" / "meshes" / "lamp.stl")
    (tmp_path / "lamp" / "model.config").write_text("<model><sdf version='1.6'>lamp-1_6.sdf</sdf></model>")
    (tmp_path / "lamp" / "lamp-1_6.sdf").write_text(LAMP)
    monkeypatch.setenv("GAZEBO_MODEL_PATH", str(tmp_path))
    spawnables = [each.entity_resource.uri for each in ask(shop, srv.GetSpawnables, "get_spawnables").spawnables]
    assert spawnables[0] == "model://lamp"
    assert "package://turtlebot3_description/urdf/turtlebot3_waffle.urdf.xacro" in spawnables
    assert not [uri for uri in spawnables if "wheel" in uri], "parts of robots are none"

    assert spawn(shop, "lamp", resource=Resource(uri="model://lamp")).result.result == OK
    (shape,) = shop.call(GetShapes, "/gazebo/get_shapes", names=["lamp"]).shapes
    assert shape.mesh_resource == (tmp_path / "lamp" / "meshes" / "lamp.stl").as_uri()


def test_entities_are_filtered(shop):
    spawn(shop)
    names = ask(shop, srv.GetEntities, "get_entities").entities
    assert list(names) == ["ground_plane", "shelf", "crate"]
    filters = EntityFilters(filter="^s")
    assert list(ask(shop, srv.GetEntities, "get_entities", filters=filters).entities) == ["shelf"]
    static = [EntityCategory(category=EntityCategory.CATEGORY_STATIC_OBJECT)]
    filters = EntityFilters(categories=static)
    assert list(ask(shop, srv.GetEntities, "get_entities", filters=filters).entities) == ["ground_plane", "shelf"]
    info = EntityInfo(tags=["wooden"])
    ask(shop, srv.SetEntityInfo, "set_entity_info", entity="shelf", info=info)
    filters = EntityFilters()
    filters.tags.tags = ["wooden"]
    assert list(ask(shop, srv.GetEntities, "get_entities", filters=filters).entities) == ["shelf"]
    filters = EntityFilters(filter="^[[:lower:]]+$")
    assert list(ask(shop, srv.GetEntities, "get_entities", filters=filters).entities) == ["shelf", "crate"]
    for wrong in (EntityFilters(filter="("), EntityFilters(bounds=Bounds(type=Bounds.TYPE_CONVEX_HULL))):
        answer = ask(shop, srv.GetEntities, "get_entities", filters=wrong)
        assert answer.result.result == Result.RESULT_OPERATION_FAILED


@pytest.mark.parametrize(
    ("kind", "points", "found"),
    [
        (Bounds.TYPE_BOX, [(1.4, 1.0, 1.0), (-0.4, 0.0, 0.5)], ["crate"]),  # the shelf begins at x = 1.5
        (Bounds.TYPE_BOX, [(1.6, 1.0, 1.0), (0.6, 0.0, 0.5)], ["shelf"]),  # the crate ends at x = 0.5
        (Bounds.TYPE_SPHERE, [(1.0, 0.0, 0.5), (0.4, 0.0, 0.0)], []),
        (Bounds.TYPE_SPHERE, [(1.0, 0.0, 0.5), (0.6, 0.0, 0.0)], ["shelf", "crate"]),
    ],
)
def test_entities_are_found_by_the_room_they_take(shop, kind, points, found):
    spawn(shop)
    bounds = Bounds(type=kind, points=[Vector3(x=x, y=y, z=z) for x, y, z in points])
    filters = EntityFilters(filter="^[sc]", bounds=bounds)
    assert list(ask(shop, srv.GetEntities, "get_entities", filters=filters).entities) == found


def test_states_are_read_and_set(shop):
    spawn(shop)
    state = EntityState(pose=Pose(position=Point(x=1.0, y=2.0, z=0.5)), twist=Twist(linear=Vector3(x=3.0)))
    done = ask(shop, srv.SetEntityState, "set_entity_state", entity="crate", state=state, set_pose=True, set_twist=True)
    assert done.result.result == OK
    seen = ask(shop, srv.GetEntityState, "get_entity_state", entity="crate").state
    assert (seen.pose.position.x, seen.pose.position.y, seen.twist.linear.x) == pytest.approx((1, 2, 3))
    missing = ask(shop, srv.GetEntityState, "get_entity_state", entity="ghost")
    assert missing.result.result == Result.RESULT_NOT_FOUND
    several = ask(shop, srv.GetEntitiesStates, "get_entities_states", filters=EntityFilters(filter="crate"))
    assert several.states[0].pose.position.x == pytest.approx(1)


def test_bounds_are_those_of_what_is_solid(shop):
    bounds = ask(shop, srv.GetEntityBounds, "get_entity_bounds", entity="shelf").bounds
    high, low = bounds.points
    assert (low.x, low.y, low.z) == pytest.approx((1.5, -1, 0))
    assert (high.x, high.y, high.z) == pytest.approx((2.5, 1, 1))


def test_time_is_steered(shop):
    state = SimulationState
    assert ask(shop, srv.GetSimulationState, "get_simulation_state").state.state == state.STATE_PAUSED
    spawn(shop, z=5.0)
    assert ask(shop, srv.StepSimulation, "step_simulation", steps=500).result.result == OK
    z = ask(shop, srv.GetEntityState, "get_entity_state", entity="crate").state.pose.position.z
    assert z == pytest.approx(5.0 - 0.5 * 9.8 * 0.25, rel=1e-3)
    again = ask(shop, srv.SetSimulationState, "set_simulation_state", state=state(state=state.STATE_PAUSED))
    assert again.result.result == srv.SetSimulationState.Response.ALREADY_IN_TARGET_STATE
    ask(shop, srv.SetSimulationState, "set_simulation_state", state=state(state=state.STATE_PLAYING))
    running = ask(shop, srv.StepSimulation, "step_simulation", steps=1)
    assert running.result.result == Result.RESULT_INCORRECT_STATE
    ask(shop, srv.SetSimulationState, "set_simulation_state", state=state(state=state.STATE_STOPPED))
    z = ask(shop, srv.GetEntityState, "get_entity_state", entity="crate").state.pose.position.z
    assert z == pytest.approx(5.0)


def test_a_reset_may_take_spawned_entities_away(shop):
    spawn(shop)
    scope = srv.ResetSimulation.Request.SCOPE_SPAWNED
    assert ask(shop, srv.ResetSimulation, "reset_simulation", scope=scope).result.result == OK
    assert "crate" not in ask(shop, srv.GetEntities, "get_entities").entities


def test_a_whole_reset_is_as_if_the_world_was_loaded_anew(shop):
    assert ask(shop, srv.DeleteEntity, "delete_entity", entity="shelf").result.result == OK
    assert spawn(shop, "crate").result.result == OK
    assert ask(shop, srv.ResetSimulation, "reset_simulation").result.result == OK
    assert sorted(ask(shop, srv.GetEntities, "get_entities").entities) == ["ground_plane", "shelf"]
    assert ask(shop, srv.GetEntityState, "get_entity_state", entity="shelf").state.pose.position.x == pytest.approx(2.0)


def test_steps_are_an_action(shop):
    client = ActionClient(shop.client, SimulateSteps, "/gazebo/simulate_steps")
    assert client.wait_for_server(5.0)
    told = []
    goal = SimulateSteps.Goal(steps=250)
    result = client.send_goal(goal, feedback_callback=lambda message: told.append(message.feedback.completed_steps))
    assert result.result.result.result == OK
    assert told[-1] == 250
    assert shop.server._paced.simulation.time_ns == 250_000_000


def test_steps_can_be_cancelled(shop):
    client = ActionClient(shop.client, SimulateSteps, "/gazebo/simulate_steps")
    assert client.wait_for_server(5.0)
    over = Event()
    accepted = []

    def take(future):
        accepted.append(future.result())
        accepted[0].get_result_async().add_done_callback(lambda _: over.set())
        accepted[0].cancel_goal_async()

    steps = 100_000_000
    client.send_goal_async(SimulateSteps.Goal(steps=steps)).add_done_callback(take)
    assert over.wait(10.0)
    assert accepted[0].status == GoalStatus.STATUS_CANCELED
    assert shop.server._paced.simulation.time_ns < steps * 1_000_000


def test_worlds_are_exchanged(shop):
    other = WORLD.replace('name="shop"', 'name="hall"').replace("shelf", "rack")
    done = ask(shop, srv.LoadWorld, "load_world", world_resource=Resource(resource_string=other))
    assert (done.result.result, done.world.name) == (OK, "hall")
    assert list(ask(shop, srv.GetEntities, "get_entities").entities) == ["ground_plane", "rack"]
    broken = ask(shop, srv.LoadWorld, "load_world", world_resource=Resource(resource_string="<sdf/>"))
    assert broken.result.result == srv.LoadWorld.Response.RESOURCE_PARSE_ERROR
    assert ask(shop, srv.GetCurrentWorld, "get_current_world").world.name == "hall"
    assert ask(shop, srv.UnloadWorld, "unload_world").result.result == OK
    assert not ask(shop, srv.GetEntities, "get_entities").entities


def test_worlds_and_places_are_listed(shop):
    worlds = ask(shop, srv.GetAvailableWorlds, "get_available_worlds").worlds
    assert "arena" in [world.name for world in worlds]
    (pose,) = ask(shop, srv.GetNamedPoses, "get_named_poses").poses
    around = ask(shop, srv.GetNamedPoseBounds, "get_named_pose_bounds", name="door")
    assert (around.result.result, around.bounds.type) == (OK, Bounds.TYPE_EMPTY)
    nowhere = ask(shop, srv.GetNamedPoseBounds, "get_named_pose_bounds", name="window")
    assert nowhere.result.result == Result.RESULT_NOT_FOUND
    assert (pose.name, pose.pose.position.y) == ("door", 4.0)
    features = ask(shop, srv.GetSimulatorFeatures, "get_simulator_features").features
    assert features.STEP_SIMULATION_ACTION in features.features
    assert list(features.spawn_formats) == ["urdf", "sdf"]


def test_gzs_services_do_the_same(shop):
    factory = EntityFactory(name="crate", sdf=BOX, pose=Pose(position=Point(z=2.0)))
    assert shop.call(SpawnEntity, "/world/shop/create", entity_factory=factory).success
    moved = Pose(position=Point(x=1.0, z=2.0))
    assert shop.call(SetEntityPose, "/world/shop/set_pose", entity=Entity(name="crate"), pose=moved).success
    assert shop.call(ControlWorld, "/world/shop/control", world_control=WorldControl(pause=True, multi_step=10)).success
    assert shop.server._paced.simulation.time_ns == 10_000_000
    assert shop.server._paced.simulation.pose("crate").position[0] == pytest.approx(1.0)
    assert shop.call(DeleteEntity, "/world/shop/remove", entity=Entity(name="crate")).success
    assert not shop.call(DeleteEntity, "/world/shop/remove", entity=Entity(name="crate")).success


def test_gzs_wrenches_come_by_topic(shop):
    spawn(shop, z=5.0)
    simulation = shop.server._paced.simulation
    publishers = {
        name: shop.client.create_publisher(kind, f"/world/shop/wrench{name}", 10)
        for name, kind in (("", EntityWrench), ("/persistent", EntityWrench), ("/clear", Entity))
    }

    def tell(name, message, pushes):
        deadline = time.monotonic() + 10.0
        while not publishers[name].get_subscription_count() and time.monotonic() < deadline:
            Event().wait(0.01)
        publishers[name].publish(message)
        while len(simulation.forces.pushes) != pushes and time.monotonic() < deadline:
            Event().wait(0.01)
        assert len(simulation.forces.pushes) == pushes

    def ahead():
        return simulation.velocity("crate")[0][0]

    def steps(count):
        shop.call(ControlWorld, "/world/shop/control", world_control=WorldControl(pause=True, multi_step=count))

    wrench = EntityWrench(entity=Entity(name="crate", type=Entity.MODEL), wrench=Wrench(force=Vector3(x=4.0)))
    tell("", wrench, 1)
    steps(100)
    assert ahead() == pytest.approx(0.002, rel=1e-3)  # for one step
    tell("/persistent", wrench, 1)
    steps(100)
    assert ahead() == pytest.approx(0.202, rel=1e-3)
    tell("/clear", Entity(name="crate::body", type=Entity.LINK), 0)
    steps(100)
    assert ahead() == pytest.approx(0.202, rel=1e-3)


@pytest.mark.parametrize(
    ("physics", "speed"),
    [
        ("<max_step_size>0.002</max_step_size>", 1.0),
        ("<max_step_size>0.002</max_step_size><real_time_update_rate>1500</real_time_update_rate>", 3.0),
        ("<real_time_update_rate>0</real_time_update_rate>", 0.0),
        ("<real_time_factor>0.5</real_time_factor>", 0.5),
    ],
)
def test_a_world_says_how_fast_it_wants_to_be(physics, speed):
    text = f"<sdf version='1.6'><world name='w'><physics type='ode'>{physics}</physics></world></sdf>"
    assert wanted_speed(read_world(None, text).physics) == pytest.approx(speed)
