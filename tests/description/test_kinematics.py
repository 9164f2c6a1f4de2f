from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from daidalos.common.pose3 import Pose
from daidalos.description import sdf, urdf
from daidalos.description.joint import Axis, Joint, JointType, Mimic
from daidalos.description.kinematics import KinematicTree, UnknownJointError, link_poses_at_zero
from daidalos.description.link import Link
from daidalos.description.robot import Robot
from description.robots import ARM


def random_robot(joints, rng, chain=False):
    kinds = (JointType.REVOLUTE, JointType.CONTINUOUS, JointType.PRISMATIC, JointType.FIXED)
    links = {f"l{i}": Link(f"l{i}") for i in range(joints + 1)}
    made = {}
    for i in range(joints):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        made[f"j{i}"] = Joint(
            name=f"j{i}",
            type=kinds[rng.integers(len(kinds))],
            parent=f"l{i if chain else rng.integers(i + 1)}",
            child=f"l{i + 1}",
            origin=Pose.from_xyz_rpy(tuple(rng.normal(size=3)), tuple(rng.normal(size=3))),
            anchor=Pose.from_xyz_rpy(tuple(rng.normal(size=3)), tuple(rng.normal(size=3))),
            axes=(Axis(tuple(axis)),),
        )
    return Robot("r", links, made, "l0")


def readable_poses(robot, values):
    """The same by hand: one joint after the other, with scipy's rotations."""
    poses = {robot.root: np.eye(4)}
    for joint in robot.joints.values():
        motion = np.eye(4)
        q = values.get(joint.name, 0.0)
        if joint.type is JointType.PRISMATIC:
            motion[:3, 3] = q * np.array(joint.axis.xyz)
        elif joint.type is not JointType.FIXED:
            motion[:3, :3] = Rotation.from_rotvec(q * np.array(joint.axis.xyz)).as_matrix()
        poses[joint.child] = poses[joint.parent] @ joint.origin.matrix @ motion @ np.linalg.inv(joint.anchor.matrix)
    return poses


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("chain", [False, True])
def test_poses_of_random_trees(seed, chain):
    rng = np.random.default_rng(seed)
    robot = random_robot(40, rng, chain)
    tree = KinematicTree(robot)
    q = rng.normal(size=len(tree.joint_names))
    expected = readable_poses(robot, dict(zip(tree.joint_names, q, strict=True)))
    for name, matrix in zip(tree.link_names, tree.link_matrices(q), strict=True):
        np.testing.assert_allclose(matrix, expected[name], atol=1e-9)


def test_arm_in_closed_form():
    tree = KinematicTree(urdf.parse(ARM))
    assert tree.joint_names == ("shoulder", "elbow", "grip")
    q = tree.positions({"shoulder": 0.5, "elbow": -0.5, "grip": 0.03})
    translations, _ = tree.link_poses(q)
    place = dict(zip(tree.link_names, translations, strict=True))
    # The shoulder's frame is turned so that its x points along the base's y; turning about y dips x.
    elbow = [0, np.cos(0.5), 1 - np.sin(0.5)]
    np.testing.assert_allclose(place["fore"], elbow, atol=1e-12)
    np.testing.assert_allclose(place["finger"], np.add(elbow, [-0.13, 1, 0]), atol=1e-12)
    # The mimic: twice as far plus 0.01, the other way.
    np.testing.assert_allclose(place["thumb"], np.add(elbow, [0.17, 1, 0]), atol=1e-12)
    assert tree.moving.all()


def test_mimics_follow_mimics():
    robot = urdf.parse(ARM)
    joints = dict(robot.joints)
    joints["grip"] = replace(joints["grip"], mimic=Mimic("elbow", -1.0, 0.5))
    tree = KinematicTree(replace(robot, joints=joints))
    assert tree.joint_names == ("shoulder", "elbow")
    translations, _ = tree.joint_transforms(tree.positions({"elbow": 0.2}))
    thumb = translations[tree.children.index("thumb")]
    np.testing.assert_allclose(thumb, [1, -0.1 - (2 * (0.5 - 0.2) + 0.01), 0], atol=1e-12)


def test_fixed_joints_do_not_move():
    robot = urdf.parse(ARM.replace('type="continuous"', 'type="fixed"'))
    tree = KinematicTree(robot)
    assert tree.transform_joints == ("shoulder", "elbow", "grip", "grip_mirror")
    assert tree.moving.tolist() == [True, False, True, True]


def test_unknown_joint_names_those_there_are():
    tree = KinematicTree(urdf.parse(ARM))
    with pytest.raises(UnknownJointError, match="'wrist' is not in the robot; movable are shoulder, elbow, grip"):
        tree.positions({"wrist": 1.0})


def test_a_robot_of_one_link():
    tree = KinematicTree(urdf.parse("<robot name='r'><link name='a'/></robot>"))
    translations, rotations = tree.link_poses(np.zeros(0))
    np.testing.assert_allclose(translations, [[0, 0, 0]])
    np.testing.assert_allclose(rotations, [[0, 0, 0, 1]])


def test_models_have_their_links_in_the_models_frame():
    model = sdf.parse_model(
        """<sdf version="1.9"><model name="m">
        <link name="a"><pose>1 0 0 0 0 0</pose></link>
        <link name="b"><pose>1 0 2 0 0 1.5707963267948966</pose></link>
        <joint name="j" type="revolute"><pose>0 -1 0 0 0 0</pose><parent>a</parent><child>b</child>
          <axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"""
    )
    tree = KinematicTree(model)
    np.testing.assert_allclose(tree.link_poses(np.zeros(1))[0], [[1, 0, 0], [1, 0, 2]], atol=1e-12)
    # The joint is 1 m along the model's x from b; half a turn puts b on its other side.
    np.testing.assert_allclose(tree.link_poses(np.array([np.pi]))[0][1], [3, 0, 2], atol=1e-12)


def test_poses_at_zero():
    robot = random_robot(10, np.random.default_rng(3))
    expected = readable_poses(robot, {})
    for name, pose in link_poses_at_zero(robot).items():
        np.testing.assert_allclose(pose.matrix, expected[name], atol=1e-9)


def test_transforms_of_some_joints_are_those_of_all():
    tree = KinematicTree(random_robot(9, np.random.default_rng(5)))
    positions = np.linspace(-1.0, 1.0, len(tree.joint_names))
    rows = np.array([7, 2, 3])
    for some, every in zip(tree.joint_transforms(positions, rows), tree.joint_transforms(positions), strict=True):
        np.testing.assert_array_equal(some, every[rows])
