import numpy as np

from daidalos.samples.odometry import planar_covariance


def test_the_covariance_of_a_planar_pose_has_large_variances_out_of_the_plane():
    covariance = planar_covariance(1, 2, 3).reshape(6, 6)
    assert np.diag(covariance).tolist() == [1, 2, 1e12, 1e12, 1e12, 3]
