"""The services of Gazebo classic, as a program would call them."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from daidalos_msgs.srv import BringBack, SetFriction
from gazebo_msgs import srv
from gazebo_msgs.msg import EntityState, LinkState, ModelState, ODEJointProperties
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from rclpy.parameter import Parameter
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Empty, Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nodes.gazebo_ros.conftest import ARM, BOX


def at(x, y=0.0, z=0.5):
    return Pose(position=Point(x=x, y=y, z=z))


def spawn(shop, name="crate", xml=BOX, pose=None, **fields):
    return shop.call(srv.SpawnEntity, "/spawn_entity", name=name, xml=xml, initial_pose=pose or at(0.0), **fields)


def step(shop, count):
    shop.server._host.step(count)


def state(shop, name, reference=""):
    return shop.call(srv.GetEntityState, "/gazebo/get_entity_state", name=name, reference_frame=reference)


def test_models_come_and_go(shop):
    assert spawn(shop).success
    told = shop.call(srv.GetModelList, "/get_model_list")
    assert told.model_names == ["ground_plane", "shelf", "crate"]
    assert (told.header.frame_id, told.header.stamp.sec) == ("world", 0)  # simulated time
    again = spawn(shop)
    assert not again.success
    assert "'crate' is in the simulation already" in again.status_message
    assert shop.call(srv.DeleteEntity, "/delete_entity", name="crate").success
    gone = shop.call(srv.DeleteEntity, "/delete_entity", name="crate")
    assert not gone.success
    assert "no model 'crate'; known are ground_plane, shelf" in gone.status_message


def test_a_faulty_description_is_explained(shop):
    answer = spawn(shop, xml="<robot name='r'><link/></robot>")
    assert not answer.success
    assert "<link>" in answer.status_message


def test_ros1s_names_work_too(shop):
    answer = shop.call(srv.SpawnModel, "/gazebo/spawn_sdf_model", model_name="c", model_xml=BOX)
    assert answer.success
    assert shop.call(srv.GetModelState, "/gazebo/get_model_state", model_name="c").success
    assert shop.call(srv.DeleteModel, "/gazebo/delete_model", model_name="c").success


def test_poses_may_be_relative(shop):
    spawn(shop, pose=at(1.0, 0.0, 0.0), reference_frame="shelf")
    assert state(shop, "crate").state.pose.position.x == pytest.approx(3.0)
    assert state(shop, "crate::body", "shelf").state.pose.position.x == pytest.approx(1.0)
    moved = EntityState(
        name="crate", pose=at(0.0, 1.0, 0.0), twist=Twist(linear=Vector3(x=1.0)), reference_frame="shelf"
    )
    assert shop.call(srv.SetEntityState, "/set_entity_state", state=moved).success
    answer = state(shop, "crate")
    assert (answer.state.pose.position.x, answer.state.pose.position.y) == pytest.approx((2.0, 1.0))
    assert answer.state.twist.linear.x == pytest.approx(1.0)
    assert not state(shop, "nobody").success


def test_ros1s_states_are_those_of_models_and_links(shop):
    spawn(shop)
    model = ModelState(model_name="crate", pose=at(0.0, 1.0), twist=Twist(linear=Vector3(x=1.0)))
    assert shop.call(srv.SetModelState, "/gazebo/set_model_state", model_state=model).success
    link = shop.call(srv.GetLinkState, "/gazebo/get_link_state", link_name="crate::body", reference_frame="shelf")
    assert link.success
    assert (link.link_state.link_name, link.link_state.reference_frame) == ("crate::body", "shelf")
    assert (link.link_state.pose.position.x, link.link_state.pose.position.y) == pytest.approx((-2.0, 1.0))
    assert link.link_state.twist.linear.x == pytest.approx(1.0)
    moved = LinkState(link_name="crate::body", pose=at(0.0, 2.0))
    assert shop.call(srv.SetLinkState, "/gazebo/set_link_state", link_state=moved).success
    assert state(shop, "crate").state.pose.position.y == pytest.approx(2.0)
    assert not shop.call(srv.GetLinkState, "/gazebo/get_link_state", link_name="crate::nothing").success


def test_orientations_need_no_length_of_one(shop):
    assert spawn(shop).success
    turned = Pose(position=Point(x=1.0, z=0.5), orientation=Quaternion(z=2.0, w=2.0))
    assert shop.call(srv.SetEntityState, "/set_entity_state", state=EntityState(name="crate", pose=turned)).success
    found = state(shop, "crate").state.pose
    assert (found.orientation.z, found.orientation.w) == pytest.approx((0.5**0.5, 0.5**0.5))
    beside = EntityState(name="shelf", reference_frame="crate", pose=at(1.0, 0.0, 0.0))
    assert shop.call(srv.SetEntityState, "/set_entity_state", state=beside).success
    assert state(shop, "shelf").state.pose.position.y == pytest.approx(1.0)


def test_numbers_that_are_none_are_refused(shop):
    assert spawn(shop).success
    for wrong in (at(math.nan), Pose(orientation=Quaternion(x=math.inf))):
        assert not shop.call(
            srv.SetEntityState, "/set_entity_state", state=EntityState(name="crate", pose=wrong)
        ).success
        assert "finite" in spawn(shop, "other", pose=wrong).status_message
    push = Wrench(force=Vector3(x=math.nan))
    assert not shop.call(srv.ApplyLinkWrench, "/apply_link_wrench", link_name="crate::body", wrench=push).success
    assert not shop.call(srv.SetPhysicsProperties, "/set_physics_properties", max_update_rate=math.nan).success
    step(shop, 10)
    assert state(shop, "crate").state.pose.position.x == pytest.approx(0.0)


def test_states_can_be_saved_and_restored(shop):
    spawn(shop, pose=at(0.0, 0.0, 5.0))
    assert not shop.call(Trigger, "/gazebo/restore_state").success
    step(shop, 100)
    before = state(shop, "crate").state.pose.position.z
    assert shop.call(Trigger, "/gazebo/save_state").success
    step(shop, 300)
    assert state(shop, "crate").state.pose.position.z < before
    assert shop.call(Trigger, "/gazebo/restore_state").success
    assert state(shop, "crate").state.pose.position.z == before


def test_a_world_is_reset_without_its_time(shop):
    spawn(shop, pose=at(0.0, 0.0, 5.0))
    step(shop, 200)
    shop.call(Empty, "/reset_world")
    world = shop.call(srv.GetWorldProperties, "/gazebo/get_world_properties")
    assert world.sim_time == pytest.approx(0.2)
    assert state(shop, "crate").state.pose.position.z == pytest.approx(5.0)
    shop.call(Empty, "/reset_simulation")
    assert shop.call(srv.GetWorldProperties, "/gazebo/get_world_properties").sim_time == 0.0


def test_physics_can_be_changed(shop):
    spawn(shop, pose=at(0.0, 0.0, 5.0))
    answer = shop.call(
        srv.SetPhysicsProperties,
        "/set_physics_properties",
        time_step=0.002,
        max_update_rate=1000.0,
        gravity=Vector3(z=1.0),
    )
    assert answer.success
    physics = shop.call(srv.GetPhysicsProperties, "/get_physics_properties")
    assert (physics.time_step, physics.max_update_rate, physics.gravity.z, physics.pause) == (0.002, 1000.0, 1.0, True)
    assert shop.server._paced.real_time_factor == pytest.approx(2.0)
    step(shop, 500)
    assert state(shop, "crate").state.twist.linear.z == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf])
def test_a_speed_that_can_not_be_is_refused(shop, value):
    (answer,) = shop.server.set_parameters([Parameter("real_time_factor", value=value)])
    assert not answer.successful
    assert "real_time_factor" in answer.reason
    assert shop.server._paced.real_time_factor == 1.0


@pytest.mark.parametrize(
    ("apply", "clear", "kind", "field"),
    [
        (srv.ApplyLinkWrench, srv.LinkRequest, "link", "link_name"),
        (srv.ApplyBodyWrench, srv.BodyRequest, "body", "body_name"),
    ],
)
def test_links_are_pushed(shop, apply, clear, kind, field):
    spawn(shop, pose=at(0.0, 0.0, 5.0))
    link = {field: "crate::body"}
    wrench = Wrench(force=Vector3(x=4.0, z=2 * 9.8))
    half_a_second = Duration(sec=0, nanosec=500_000_000)
    assert shop.call(apply, f"/apply_{kind}_wrench", **link, wrench=wrench, duration=half_a_second).success
    step(shop, 500)
    assert state(shop, "crate").state.twist.linear.x == pytest.approx(1.0, rel=1e-3)
    shop.call(apply, f"/apply_{kind}_wrench", **link, wrench=wrench, duration=Duration(sec=-1))
    shop.call(clear, f"/clear_{kind}_wrenches", **link)
    step(shop, 100)
    assert state(shop, "crate").state.twist.linear.x == pytest.approx(1.0, rel=1e-3)
    assert not shop.call(apply, f"/apply_{kind}_wrench", **{field: "crate::tail"}).success


def test_joints_have_properties_and_take_efforts(shop):
    spawn(shop, "arm", ARM)
    joint = shop.call(srv.GetJointProperties, "/get_joint_properties", joint_name="arm::j")
    assert (joint.type, list(joint.damping), list(joint.position)) == (0, [0.5], [0.0])
    forever = Duration(sec=-1)
    shop.call(srv.ApplyJointEffort, "/apply_joint_effort", joint_name="j", effort=0.5, duration=forever)
    step(shop, 2000)
    # At the terminal speed, damping carries the effort.
    assert shop.call(srv.GetJointProperties, "/get_joint_properties", joint_name="j").rate[0] == pytest.approx(
        1, rel=0.02
    )
    config = ODEJointProperties(damping=[1.0])
    assert shop.call(srv.SetJointProperties, "/set_joint_properties", joint_name="j", ode_joint_config=config).success
    shop.call(srv.JointRequest, "/clear_joint_efforts", joint_name="j")
    assert shop.call(
        srv.SetModelConfiguration,
        "/set_model_configuration",
        model_name="arm",
        joint_names=["j"],
        joint_positions=[0.7],
    ).success
    joint = shop.call(srv.GetJointProperties, "/get_joint_properties", joint_name="j")
    assert (joint.damping[0], joint.position[0]) == (1.0, pytest.approx(0.7))


def test_joints_follow_a_trajectory(shop):
    spawn(shop, "arm", ARM)
    points = [
        JointTrajectoryPoint(positions=[angle], time_from_start=Duration(sec=second))
        for second, angle in ((0, 0.0), (1, 0.8), (2, 0.2))
    ]
    course = JointTrajectory(joint_names=["j"], points=points)
    asked = {"model_name": "arm", "joint_trajectory": course, "set_model_pose": True, "model_pose": at(1.0, z=2.0)}
    assert shop.call(srv.SetJointTrajectory, "/gazebo/set_joint_trajectory", **asked).success
    for milliseconds, angle in ((500, 0.4), (500, 0.8), (500, 0.5)):
        step(shop, milliseconds)
        joint = shop.call(srv.GetJointProperties, "/get_joint_properties", joint_name="j")
        assert joint.position[0] == pytest.approx(angle, abs=0.002)
    assert state(shop, "arm").state.pose.position.x == pytest.approx(1.0)
    wrong = JointTrajectory(joint_names=["elbow"], points=points)
    answer = shop.call(srv.SetJointTrajectory, "/set_joint_trajectory", model_name="arm", joint_trajectory=wrong)
    assert not answer.success
    assert "elbow" in answer.status_message


def test_friction_is_changed_while_running(shop):
    """A crate that slides stops after v^2 / (2 mu g), or not at all."""
    spawn(shop, pose=at(0.0, 3.0))
    for friction, way in ((0.1, 1.0**2 / (2 * 0.1 * 9.8)), (0.0, 1.5)):
        assert shop.call(SetFriction, "/gazebo/set_friction", name="crate", friction=friction).success
        start = EntityState(name="crate", pose=at(0.0, 3.0), twist=Twist(linear=Vector3(x=1.0)))
        assert shop.call(srv.SetEntityState, "/set_entity_state", state=start).success
        step(shop, 1500)
        assert state(shop, "crate").state.pose.position.x == pytest.approx(way, rel=0.1)
    assert not shop.call(SetFriction, "/gazebo/set_friction", name="crate", friction=-1.0).success
    assert not shop.call(SetFriction, "/gazebo/set_friction", name="nobody", friction=1.0).success


def test_models_and_links_have_properties(shop):
    spawn(shop)
    model = shop.call(srv.GetModelProperties, "/get_model_properties", model_name="crate")
    assert (model.canonical_body_name, list(model.body_names), model.is_static) == ("body", ["body"], False)
    link = shop.call(srv.GetLinkProperties, "/get_link_properties", link_name="crate::body")
    assert (link.mass, link.ixx, link.gravity_mode) == (2.0, 0.3, True)
    fields = {"link_name": "crate::body", "mass": 4.0, "ixx": 0.5, "iyy": 0.5, "izz": 0.5, "gravity_mode": False}
    fields["com"] = Pose()
    assert shop.call(srv.SetLinkProperties, "/set_link_properties", **fields).success
    link = shop.call(srv.GetLinkProperties, "/get_link_properties", link_name="crate::body")
    assert (link.mass, link.gravity_mode) == (4.0, False)
    before = state(shop, "crate").state.pose.position.z
    shop.call(srv.SetEntityState, "/set_entity_state", state=EntityState(name="crate", pose=at(0.0, 0.0, 5.0)))
    step(shop, 500)
    assert state(shop, "crate").state.pose.position.z == pytest.approx(5.0, abs=1e-6)
    assert before == pytest.approx(0.5)


def test_lights_are_changed(shop):
    light = shop.call(srv.GetLightProperties, "/get_light_properties", light_name="sun")
    assert light.success
    red = ColorRGBA(r=1.0, g=0.0, b=0.0, a=1.0)
    assert shop.call(srv.SetLightProperties, "/set_light_properties", light_name="sun", diffuse=red).success
    assert shop.call(srv.GetLightProperties, "/get_light_properties", light_name="sun").diffuse == red
    assert shop.call(srv.DeleteLight, "/delete_light", light_name="sun").success
    assert not shop.call(srv.GetLightProperties, "/get_light_properties", light_name="sun").success


def test_a_grippers_switch_comes_and_goes_with_its_model(shop):
    from std_srvs.srv import SetBool

    plugin = (
        "<plugin name='p' filename='libgazebo_ros_vacuum_gripper.so'><ros><namespace>hand</namespace></ros>"
        "<link_name>body</link_name></plugin></model>"
    )
    spawn(shop, xml=BOX.replace("</model>", plugin))
    assert shop.call(SetBool, "/hand/switch", data=True).success
    shop.call(srv.DeleteEntity, "/delete_entity", name="crate")
    assert "/hand/switch" not in dict(shop.server.get_service_names_and_types_by_node("gazebo", "/"))


def test_shapes_are_inserted_and_scaled(shop):
    from daidalos_msgs.srv import InsertShape, ScaleEntity

    fields = {"shape": "box", "size": Vector3(x=1.0, y=1.0, z=1.0), "mass": 2.0, "pose": at(0.0)}
    first, second = (shop.call(InsertShape, "/gazebo/insert_shape", **fields) for _ in range(2))
    assert (first.name, second.name) == ("box", "box_0")
    assert shop.call(ScaleEntity, "/gazebo/scale_entity", name="box", factors=Vector3(x=2.0, y=1.0, z=2.0)).success
    assert state(shop, "box").state.pose.position.z == pytest.approx(1.0)
    wrong = shop.call(InsertShape, "/gazebo/insert_shape", shape="cube")
    assert not wrong.success
    assert "no shape 'cube'" in wrong.status_message
    assert not shop.call(
        ScaleEntity, "/gazebo/scale_entity", name="nobody", factors=Vector3(x=2.0, y=2.0, z=2.0)
    ).success


def test_what_was_deleted_comes_back_as_it_was(shop):
    def bring_back(name):
        return shop.call(BringBack, "/gazebo/bring_back", name=name)

    assert spawn(shop, "arm", ARM, at(1.0, 2.0, 0.0), robot_namespace="left").success
    distort = {"model_name": "arm", "joint_names": ["j"], "joint_positions": [0.7]}
    assert shop.call(srv.SetModelConfiguration, "/set_model_configuration", **distort).success
    moved = EntityState(name="shelf", pose=at(-3.0))
    assert shop.call(srv.SetEntityState, "/set_entity_state", state=moved).success
    for name in ("arm", "shelf"):
        assert shop.call(srv.DeleteEntity, "/delete_entity", name=name).success
    for name in ("shelf", "arm"):
        assert bring_back(name).success
    assert state(shop, "shelf").state.pose.position.x == pytest.approx(-3.0)
    assert state(shop, "arm").state.pose.position.y == pytest.approx(2.0)
    joint = shop.call(srv.GetJointProperties, "/get_joint_properties", joint_name="arm::j")
    assert joint.position == pytest.approx([0.7])
    assert shop.server._host.spawned == {"arm"}
    assert "no model 'arm' was deleted" in bring_back("arm").status_message
    assert shop.call(srv.DeleteEntity, "/delete_entity", name="shelf").success
    assert spawn(shop, "shelf").success
    assert "in the simulation already" in bring_back("shelf").status_message


def test_looks_of_models_are_told(shop):
    from daidalos_msgs.srv import GetShapes, InsertShape

    fields = {"shape": "cylinder", "size": Vector3(x=0.4, y=0.0, z=1.0), "mass": 2.0, "pose": at(0.0)}
    name = shop.call(InsertShape, "/gazebo/insert_shape", **fields).name
    seen = shop.call(GetShapes, "/gazebo/get_shapes", names=[name])
    assert seen.success
    (shape,) = seen.shapes
    assert (shape.type, shape.header.frame_id) == (shape.CYLINDER, "cylinder::link")
    assert (shape.scale.x, shape.scale.y, shape.scale.z) == (0.4, 0.4, 1.0)
    assert list(seen.entities) == ["cylinder", "cylinder::link"]
    assert seen.poses[0].position.z == pytest.approx(state(shop, name).state.pose.position.z, abs=1e-3)
    assert name in shop.call(GetShapes, "/gazebo/get_shapes").entities
    wrong = shop.call(GetShapes, "/gazebo/get_shapes", names=["nobody"])
    assert not wrong.success
    assert "nobody" in wrong.status_message


def test_every_shape_is_told_as_it_looks(shop, tmp_path):
    from daidalos_msgs.srv import GetShapes

    image = tmp_path / "sign.png"
    image.write_bytes(b"")
    sign = f"<material><pbr><metal><albedo_map>{image}</albedo_map></metal></pbr></material>"
    shapes = (
        ("<box><size>1 1 1</size></box>", sign),
        ("<capsule><radius>0.2</radius><length>1</length></capsule>", ""),
        ("<cone><radius>0.5</radius><length>2</length></cone>", ""),
        ("<polyline><point>0 0</point><point>1 0</point><point>1 1</point><height>0.5</height></polyline>", ""),
    )
    visuals = (
        f"<visual name='v{i}'><geometry>{shape}</geometry>{look}</visual>" for i, (shape, look) in enumerate(shapes)
    )
    xml = f"<sdf version='1.11'><model name='zoo'><link name='l'>{''.join(visuals)}</link></model></sdf>"
    assert spawn(shop, "zoo", xml).success
    box, middle, low, high, *others = shop.call(GetShapes, "/gazebo/get_shapes", names=["zoo"]).shapes
    assert (box.type, box.texture_resource, box.color.r) == (box.CUBE, image.as_uri(), 1.0)
    assert (middle.type, middle.scale.z) == (middle.CYLINDER, 1.0)
    assert [(end.type, end.scale.x, end.pose.position.z) for end in (low, high)] == [
        (low.SPHERE, 0.4, -0.5),
        (low.SPHERE, 0.4, 0.5),
    ]
    extents = []
    for each in others:
        assert (each.type, len(each.points) % 3) == (each.TRIANGLE_LIST, 0)
        extents.append([np.ptp([getattr(point, axis) for point in each.points]) for axis in "xyz"])
    assert np.array(extents) == pytest.approx(np.array([[1, 1, 2], [1, 1, 0.5]]), abs=0.02)


def test_terrain_is_told_by_its_larger_forms(shop, tmp_path):
    from daidalos_msgs.srv import GetShapes
    from PIL import Image

    heights = np.add.outer(np.zeros(129), np.linspace(0, 255, 129)).astype(np.uint8)
    Image.fromarray(heights).save(tmp_path / "ramp.png")
    shape = f"<heightmap><uri>{tmp_path}/ramp.png</uri><size>20 10 3</size></heightmap>"
    xml = (
        f"<sdf version='1.9'><model name='hill'><static>true</static><link name='l'><visual name='v'><geometry>{shape}"
    )
    assert spawn(shop, "hill", f"{xml}</geometry></visual></link></model></sdf>", at(0.0, 0.0, 0.0)).success
    (ramp,) = shop.call(GetShapes, "/gazebo/get_shapes", names=["hill"]).shapes
    points = np.array([(point.x, point.y, point.z) for point in ramp.points])
    assert len(points) == 6 * 40 * 40
    assert np.ptp(points, axis=0) == pytest.approx((20, 10, 3))
    assert points[:, 2] == pytest.approx((points[:, 0] / 20 + 0.5) * 3, abs=0.02)
    a, b, c = points.reshape(-1, 3, 3).swapaxes(0, 1)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all(), "seen from above"


def test_the_state_plugin_may_name_a_place_of_its_own(shop):
    answer = shop.call(srv.GetEntityState, "/demo/get_entity_state", name="shelf")
    assert answer.success
    assert answer.state.pose.position.x == pytest.approx(2.0)
    assert "/demo/model_states" in dict(shop.server.get_topic_names_and_types())
