"""Environments of Gymnasium, checked with its own checker."""

import math

import numpy as np
import pytest

from daidalos.common.errors import UserError

gymnasium = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402

from daidalos.learning import State, WorldEnv, make_vector  # noqa: E402

ARM = """\
<robot name='pendulum'>
  <link name='base'><inertial><mass value='5'/>
    <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
  <link name='rod'><inertial><origin xyz='0 0 0.5'/><mass value='1'/>
    <inertia ixx='0.1' ixy='0' ixz='0' iyy='0.1' iyz='0' izz='0.1'/></inertial></link>
  <link name='world'/>
  <joint name='fixed' type='fixed'><parent link='world'/><child link='base'/><origin xyz='0 0 1'/></joint>
  <joint name='hinge' type='revolute'><parent link='base'/><child link='rod'/><axis xyz='0 1 0'/>
    <limit lower='-6' upper='6' effort='10' velocity='10'/></joint>
</robot>
"""


@pytest.mark.parametrize("motion", ["dynamics", "kinematic"])
@pytest.mark.filterwarnings("ignore:.*Box observation space.*", "ignore:.*not within the observation space.*")
def test_gymnasium_accepts_it_and_seeds_are_honoured(motion: str) -> None:
    env = gymnasium.make("daidalos.learning:daidalos/World-v0", motion=motion, rays=16, max_steps=20)
    check_env(env.unwrapped, skip_render_check=True)
    actions = np.random.default_rng(0).uniform(-0.2, 0.2, (10, 2))

    def episode(seed: int) -> list[bytes]:
        observation, _ = env.reset(seed=seed)
        return [observation["lidar"].tobytes(), *(env.step(action)[0]["lidar"].tobytes() for action in actions)]

    for again in range(30):  # wherever the robot was before, and that may be beyond the walls
        assert env.reset(seed=again)[1]["state"].x == env.reset(seed=again)[1]["state"].x
        env.reset()
    assert episode(1) == episode(1)
    assert episode(1) != episode(2)


@pytest.mark.slow
def test_the_robot_moves_as_commanded_and_stops_at_walls() -> None:
    rewards: list[float] = []

    def reward(before: State, after: State) -> float:
        rewards.append(after.x - before.x)
        return rewards[-1]

    ends = {}
    for motion in ("dynamics", "kinematic"):
        env = WorldEnv(
            motion=motion, reward=reward, extra=lambda state: np.array([state.x, state.y]), extra_size=2, max_steps=300
        )
        env.reset(seed=0, options={"pose": (0.0, 0.0, 0.0)})
        for _ in range(20):
            observation, value, done, late, info = env.step(np.array([0.2, 0.0], dtype=np.float32))
        assert (done, late, value) == (False, False, rewards[-1])
        assert observation["extra"] == pytest.approx([info["state"].x, info["state"].y])
        assert observation["velocity"] == pytest.approx([0.2, 0.0], abs=0.02)
        ends[motion] = info["state"]
        while not done and not late:
            observation, _, done, late, info = env.step(np.array([5.0, 0.0], dtype=np.float32))
        assert done
        assert info["state"].collided
        assert observation["lidar"].min() < 0.5
    assert ends["kinematic"].x == pytest.approx(0.4, abs=1e-6)
    assert ends["dynamics"].x == pytest.approx(0.4, abs=0.05)
    assert math.hypot(ends["dynamics"].y, ends["dynamics"].yaw) < 0.01


def test_joints_are_driven_by_efforts(tmp_path: object) -> None:
    path = tmp_path / "arm.urdf"  # type: ignore[operator]
    path.write_text(ARM)
    env = WorldEnv("", path, rays=0, joints=("hinge",), max_effort=8.0, period=0.05)
    env.reset(seed=1, options={"pose": (0.0, 0.0, 0.0)})
    for _ in range(10):
        observation, *_ = env.step(np.array([8.0], dtype=np.float32))
    assert observation["joints"].shape == (2, 1)
    assert observation["joints"][0, 0] > 0.2


@pytest.mark.slow
def test_several_step_together_in_one_process_or_in_several() -> None:
    options = {"motion": "kinematic", "rays": 8, "camera": True, "max_steps": 3, "reward": lambda _, after: after.x}
    here, there = (make_vector(2, processes=processes, **options) for processes in (False, True))
    assert there.observation_space == here.observation_space
    firsts = [envs.reset(seed=5)[0] for envs in (here, there)]
    assert firsts[0]["lidar"].shape == (2, 8)
    assert not np.array_equal(*firsts[0]["lidar"])
    actions = np.array([[0.2, 0.5], [-0.2, 1.0]], dtype=np.float32)
    ended = []
    for _ in range(6):
        ours, theirs = here.step(actions), there.step(actions)
        for name, values in ours[0].items():
            assert np.array_equal(values, theirs[0][name]), name
        for mine, other in zip(ours[1:4], theirs[1:4], strict=True):
            assert mine.tolist() == other.tolist()
        ended.append(ours[3].tolist())
    assert ended[2] == [True, True]
    here.close()
    there.close()
    assert not any(process.is_alive() for process in there.processes)


def test_the_camera_sees_what_lies_ahead() -> None:
    env = WorldEnv(camera=True, rays=0, motion="kinematic", render_mode="rgb_array")
    first, _ = env.reset(seed=0, options={"pose": (0.0, 0.0, 0.0)})
    kept = first["camera"].copy()
    assert env.observation_space.contains(first)
    turned = env.step(np.array([0.0, 1.0], dtype=np.float32))[0]["camera"]
    assert np.array_equal(turned, env.render())
    assert not np.array_equal(turned, kept)
    assert np.array_equal(first["camera"], kept), "an observation must not change afterwards"
    again, _ = env.reset(seed=1, options={"pose": (0.0, 0.0, 0.0)})
    assert 0.0 < np.abs(again["camera"].astype(int) - kept).mean() < 4.0  # other noise, the same view
    blind = WorldEnv(rays=0, motion="kinematic", render_mode="rgb_array")
    assert "camera" not in blind.reset(seed=0, options={"pose": (0.0, 0.0, 0.0)})[0]
    assert np.array_equal(blind.render(), kept)


def test_what_is_wrong_is_named() -> None:
    with pytest.raises(UserError, match="no world file 'arenna'; did you mean 'arena'"):
        WorldEnv("arenna")
    with pytest.raises(UserError, match="no robot or model file 'wafle'; did you mean 'waffle'"):
        WorldEnv(robot="wafle")
    with pytest.raises(UserError, match="'motion' should be"):
        WorldEnv(motion="magic")
    with pytest.raises(UserError, match="'render_mode' should be 'rgb_array' or None, got 'human'"):
        WorldEnv(render_mode="human")
    with pytest.raises(UserError, match="the robot has no camera"):
        WorldEnv(robot="burger", camera=True)
    with pytest.raises(UserError, match="above 0 s"):
        WorldEnv(period=0.0)
