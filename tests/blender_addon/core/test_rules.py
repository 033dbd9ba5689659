# SPDX-License-Identifier: GPL-3.0-or-later
"""Axes, units, colours and names of frames."""

import math

import numpy as np
import pytest
from core.axes import BLENDER_FROM_GLTF, GLTF_FROM_BLENDER, z_up_from_y_up
from core.color import linear_from_srgb, linear_from_srgb_bytes, srgb_bytes_from_linear
from core.errors import printable
from core.lights import area_radiance, cone_angles, lamp_outline, point_intensity
from core.sequence import frame_path, group_sequences


def test_gltf_x_y_z_arrives_as_x_minus_z_y():
    np.testing.assert_array_equal(z_up_from_y_up([[1, 2, 3]]), [[1, -3, 2]])
    np.testing.assert_array_equal(BLENDER_FROM_GLTF @ [1, 2, 3, 1], [1, -3, 2, 1])
    np.testing.assert_array_equal(BLENDER_FROM_GLTF @ GLTF_FROM_BLENDER, np.eye(4))


def test_srgb_against_the_standard():
    # IEC 61966-2-1: 0.5 encodes as 0.735357, the linear part ends at 0.04045.
    np.testing.assert_allclose(linear_from_srgb([0, 0.04045, 0.735357, 1]), [0, 0.0031308, 0.5, 1], atol=1e-6)


def test_bytes_survive_the_way_to_linear_and_back():
    values = np.arange(256, dtype=np.uint8)
    np.testing.assert_array_equal(srgb_bytes_from_linear(linear_from_srgb_bytes(values)), values)


def test_out_of_range_colors_are_clipped():
    np.testing.assert_array_equal(srgb_bytes_from_linear([-1, 2, np.nan]), [0, 255, 0])


def test_a_lamp_of_100_watts():
    assert point_intensity(100) == pytest.approx(7.957747)
    assert area_radiance(100, 2) == pytest.approx(100 / (2 * math.pi))
    assert area_radiance(100, 2, before_4_0=True) == pytest.approx(100 / 8)


def test_hard_and_soft_cones():
    inner, outer = cone_angles(math.radians(90), 0)
    assert outer == pytest.approx(math.radians(45)) and 0.9998 * outer < inner < outer
    assert cone_angles(math.radians(90), 0.25)[0] == pytest.approx(0.75 * math.radians(45))
    assert cone_angles(math.radians(180), 0)[1] <= math.pi / 2


def area(outline):
    x, y = outline.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_outlines_of_lamps_turn_counter_clockwise():
    assert area(lamp_outline("SQUARE", 2, 9)) == pytest.approx(4)
    assert area(lamp_outline("RECTANGLE", 2, 3)) == pytest.approx(6)
    assert area(lamp_outline("DISK", 2, 9)) == pytest.approx(math.pi, rel=2e-3)
    assert area(lamp_outline("ELLIPSE", 2, 4)) == pytest.approx(2 * math.pi, rel=2e-3)


def test_numbered_files_are_one_sequence_in_order_of_frames():
    paths = ["/a/lit_0010.ply", "/a/lit_0002.ply", "/a/other.ply", "/b/lit_0001.ply", "/a/lit_0003.ply"]
    groups = group_sequences(paths)
    assert [g.paths for g in groups] == [
        ["/a/lit_0002.ply", "/a/lit_0003.ply", "/a/lit_0010.ply"],
        ["/a/other.ply"],
        ["/b/lit_0001.ply"],
    ]
    assert groups[0].frames == [2, 3, 10] and groups[0].animated and not groups[2].animated


def test_sequences_can_be_declined():
    assert len(group_sequences(["a1.ply", "a2.ply"], detect=False)) == 2


def test_the_last_file_before_the_frame_counts():
    sequence = group_sequences(["a_2.ply", "a_5.ply"])[0]
    assert [sequence.path_at(f) for f in (0, 2, 4, 5, 9)] == ["a_2.ply", "a_2.ply", "a_2.ply", "a_5.ply", "a_5.ply"]


def test_frame_paths_are_found_again():
    paths = [frame_path("dir", "lit", frame, ".ply") for frame in (1, 12345)]
    assert group_sequences(paths)[0].frames == [1, 12345]


def test_printable_is_one_short_line():
    assert printable("a\nb\x1b[2J") == "a?b?[2J"
    assert len(printable("x" * 10_000)) <= 300
