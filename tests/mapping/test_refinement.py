import numpy as np

from daidalos.common import pose2
from daidalos.mapping.pose_graph import Edge
from daidalos.mapping.refinement import refine_poses
from daidalos.mapping.scan import to_cloud

from .worlds import drive, room_scan


def test_poses_that_are_a_little_off_come_together() -> None:
    rng = np.random.default_rng(4)
    way = np.array([[-3.0, -2.3], [3.0, -2.3], [3.2, 2.2], [-3.0, 2.3], [-3.0, -2.0]])
    true = drive(way, rate=1.5)
    clouds = [to_cloud(room_scan(pose, noise=0.01, seed=k), 20.0) for k, pose in enumerate(true)]
    off = true + rng.normal(scale=[0.03, 0.03, 0.01], size=true.shape)
    off[0] = true[0]
    edges = [Edge(k, k + 1, pose2.between(off[k], off[k + 1]), np.diag([1e3, 1e3, 1e4])) for k in range(len(off) - 1)]
    refined = refine_poses(clouds, off, edges)
    before = np.hypot(*(off - true)[:, :2].T)
    after = np.hypot(*(refined - true)[:, :2].T)
    assert after.max() < 0.01 < before.mean()
    assert np.abs(pose2.wrap(refined[:, 2] - true[:, 2])).max() < 2e-3
