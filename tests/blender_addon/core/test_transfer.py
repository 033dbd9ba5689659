# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
from core.transfer import fit_values

UP = np.array([0, 0, 1], np.float32)


def nearest(targets, positions, count):
    distances = np.linalg.norm(targets[:, None, :] - positions[None, :, :], axis=2)
    order = np.argsort(distances, axis=1)[:, :count]
    return order, np.take_along_axis(distances, order, axis=1)


def fitted(targets, normals, positions, point_normals, values, count=16):
    targets, normals = np.array(targets, np.float32), np.array(normals, np.float32)
    near, far = nearest(targets, positions, count)
    return fit_values(targets, normals, near, far, positions, point_normals, values.astype(np.float32))


def sheet(seed=1, count=2000):
    positions = np.random.default_rng(seed).random((count, 3)).astype(np.float32)
    positions[:, 2] = 0
    return positions, np.tile(UP, (count, 1))


def test_a_plane_of_values_is_met_exactly_even_at_the_rim():
    positions, normals = sheet()
    values = (2 + 3 * positions[:, :1] - positions[:, 1:2]).repeat(3, 1)
    result = fitted([[0, 0, 0], [1, 1, 0], [0.5, 0.5, 0]], [UP] * 3, positions, normals, values)
    np.testing.assert_allclose(result[:, 0], [2, 4, 3], rtol=5e-3)


def test_a_constant_stays_itself():
    positions, normals = sheet()
    result = fitted([[0, 0, 0], [0.3, 0.9, 0]], [UP] * 2, positions, normals, np.full((2000, 3), 7.5))
    np.testing.assert_allclose(result, 7.5, rtol=1e-5)


def test_the_other_side_of_a_thin_wall_does_not_leak():
    positions, normals = sheet()
    both = np.concatenate([positions, positions])
    result = fitted(
        [[0.5, 0.5, 0]],
        [UP],
        both,
        np.concatenate([normals, -normals]),
        np.r_[np.ones((2000, 1)), np.zeros((2000, 1))],
        32,
    )
    np.testing.assert_allclose(result, 1, rtol=1e-5)


def test_a_corner_has_the_light_of_its_own_face():
    floor, up = sheet()
    wall = floor[:, [2, 0, 1]].copy()  # in the plane x = 0
    sideways = np.tile([1, 0, 0], (2000, 1)).astype(np.float32)
    values = np.r_[np.full((2000, 1), 5.0), np.full((2000, 1), 1.0)]
    positions, normals = np.concatenate([floor, wall]), np.concatenate([up, sideways])
    result = fitted([[0, 0.5, 0]] * 2, [UP, [1, 0, 0]], positions, normals, values, 32)
    np.testing.assert_allclose(result[:, 0], [5, 1], rtol=1e-4)


def test_no_value_below_zero_and_none_far_beyond_the_points():
    positions, normals = sheet()
    values = np.where(positions[:, :1] > 0.02, 0.0, 100.0)
    result = fitted([[0, y, 0] for y in np.linspace(0, 1, 50)], [UP] * 50, positions, normals, values)
    assert result.min() >= 0 and result.max() <= 150


def test_a_target_that_no_point_faces_takes_the_best():
    positions, normals = sheet()
    result = fitted([[0.5, 0.5, 0]], [[0, 0, -1]], positions, normals, np.full((2000, 1), 3.0))
    np.testing.assert_allclose(result, 3)


def test_fewer_points_than_neighbors():
    positions = np.zeros((1, 3), np.float32)
    near, far = np.array([[0, -1, -1]]), np.array([[0.0, 0.0, 0.0]])
    result = fit_values(positions, UP[None], near, far, positions, UP[None], np.array([[4.0]], np.float32))
    np.testing.assert_allclose(result, 4)
