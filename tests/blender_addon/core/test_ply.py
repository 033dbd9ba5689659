# SPDX-License-Identifier: GPL-3.0-or-later
import time

import numpy as np
import pytest
from core.errors import AddonError
from core.ply import read_ply
from core.read_cloud import read_cloud
from sample_files import grid_positions, our_ply, our_rows, ply_bytes

POSITIONS = np.array([[0, 0, 0], [1, 2, 3], [-4, 5, 0.25]], np.float32)


@pytest.mark.parametrize("order", ["<", ">", ""])
def test_our_file_reads_back_in_every_format(write, order):
    data = our_ply(POSITIONS, order=order, irradiance=[3.5, 1e4, 0], albedo=[1, 0.5, 0.25], radius=0.125)
    cloud = read_ply(write("lit.ply", data))
    np.testing.assert_array_equal(cloud.positions, POSITIONS)
    np.testing.assert_array_equal(cloud.normals, [[0, 0, 1]] * 3)
    np.testing.assert_array_equal(cloud.irradiance, [[3.5, 1e4, 0]] * 3)
    np.testing.assert_array_equal(cloud.albedo, [[1, 0.5, 0.25]] * 3)
    np.testing.assert_array_equal(cloud.radius, [0.125] * 3)
    np.testing.assert_array_equal(cloud.face_id, [0, 1, 2])
    assert cloud.info == {"light_units": "compat punctual 1 directional 1", "vmap": "0.1.0", "source": "room.glb"}


def test_header_gives_offset_as_doubles_and_exposure(write):
    cloud = read_ply(write("utm.ply", our_ply(POSITIONS, offset=(4500000.125, -0.1, 7.0), exposure=0.25)))
    assert cloud.offset == (4500000.125, -0.1, 7.0)
    assert cloud.exposure == 0.25


def test_y_up_is_turned_to_z_up_with_its_normals_and_offset(write):
    data = our_ply([[1, 2, 3]], offset=(10, 20, 30), up="y", normals=[[0, 1, 0]])
    cloud = read_cloud(write("lit.ply", data))
    np.testing.assert_array_equal(cloud.positions, [[1, -3, 2]])
    np.testing.assert_array_equal(cloud.normals, [[0, 0, 1]])
    assert cloud.offset == (10, -30, 20)


def test_ids_above_two_to_the_31_keep_their_bits(write):
    rows = our_rows(POSITIONS)
    rows["face_id"] = 4_000_000_000
    cloud = read_ply(write("ids.ply", ply_bytes(rows)))
    assert cloud.face_id.view(np.uint32).tolist() == [4_000_000_000] * 3


def test_colors_of_other_programs_are_srgb_albedo(write):
    rows = np.zeros(2, [(n, "f4") for n in "xyz"] + [(n, "u1") for n in ("red", "green", "blue")])
    rows["red"], rows["green"], rows["x"] = 255, 188, [0, 1]
    cloud = read_cloud(write("foreign.ply", ply_bytes(rows)))
    np.testing.assert_allclose(cloud.albedo, [[1, 0.5028865, 0]] * 2, atol=1e-6)
    assert cloud.irradiance is None and cloud.radius[0] > 0


@pytest.mark.parametrize("kind,white", [("u1", 255), ("u2", 65535), ("f4", 1)])
@pytest.mark.parametrize("order", ["<", ">", ""])
def test_white_is_white_in_every_type_of_color(write, kind, white, order):
    rows = np.zeros(1, [(n, "f4") for n in "xyz"] + [(n, kind) for n in ("red", "green", "blue")])
    rows["red"] = rows["green"] = rows["blue"] = white
    np.testing.assert_allclose(read_ply(write("white.ply", ply_bytes(rows, order))).albedo, [[1, 1, 1]], atol=1e-6)


def test_doubles_far_from_zero_get_an_offset(write):
    rows = np.zeros(2, [(n, "f8") for n in "xyz"])
    rows["x"] = [4_500_000.001, 4_500_000.002]
    cloud = read_ply(write("utm.ply", ply_bytes(rows)))
    restored = cloud.positions.astype(float)[:, 0] + cloud.offset[0]
    np.testing.assert_allclose(restored, rows["x"], rtol=0, atol=1e-8)


@pytest.mark.parametrize("order", ["<", ">"])
def test_elements_before_the_vertices_are_passed_over(write, order):
    before = (
        "element thing 2\nproperty list uchar int items\nproperty float weight\nelement other 1\nproperty double d\n"
    )
    integers = "<i4" if order == "<" else ">i4"
    data = b"\x02" + np.array([7, 8], integers).tobytes() + b"\0" * 4 + b"\0" + b"\0" * 4 + b"\0" * 8
    path = write("order.ply", ply_bytes(our_rows(POSITIONS), order, before=before, before_data=data))
    np.testing.assert_array_equal(read_ply(path).positions, POSITIONS)


def test_elements_before_the_vertices_are_passed_over_in_ascii(write):
    before = "element thing 2\nproperty list uchar int items\n"
    path = write("order.ply", ply_bytes(our_rows(POSITIONS), "", before=before, before_data=b"2 7 8\n0\n"))
    np.testing.assert_array_equal(read_ply(path).positions, POSITIONS)


def test_not_a_number_is_left_out_and_said(write):
    positions = np.array([[0, 0, 0], [np.nan, 0, 0], [1, 0, 0]], np.float32)
    rows = our_rows(positions)
    rows["irradiance_g"][2] = np.inf
    cloud = read_cloud(write("nan.ply", ply_bytes(rows)))
    np.testing.assert_array_equal(cloud.positions, [[0, 0, 0], [1, 0, 0]])
    np.testing.assert_array_equal(cloud.irradiance, [[1, 1, 1], [1, 0, 1]])
    assert len(cloud.warnings) == 2 and cloud.warnings[0].startswith("1 points")


def test_one_point_is_a_cloud(write):
    assert len(read_cloud(write("one.ply", our_ply([[0, 0, 0]])))) == 1


def test_no_point_is_an_error(write):
    with pytest.raises(AddonError, match="no points"):
        read_cloud(write("none.ply", our_ply(np.zeros((0, 3)))))


@pytest.mark.parametrize("order", ["<", ">", ""])
def test_truncated_at_every_length_is_an_error_of_one_line(write, order):
    data = our_ply(POSITIONS, order=order)
    for size in range(len(data) - (2 if order else 200)):
        with pytest.raises(AddonError) as caught:
            read_ply(write("cut.ply", data[:size]))
        assert "cut.ply" in str(caught.value) and "\n" not in str(caught.value)


BAD_HEADERS = {
    "foreign": b"solid cube\n",
    "no format": b"ply\nelement vertex 0\nproperty float x\nend_header\n",
    "unknown format": b"ply\nformat middle_endian 1.0\nend_header\n",
    "no vertices": b"ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int i\nend_header\n",
    "no position": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nend_header\n1\n",
    "no property": b"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n1\n",
    "property twice": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float x\nend_header\n1 1\n",
    "unknown type": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n1\n",
    "negative count": b"ply\nformat ascii 1.0\nelement vertex -1\nproperty float x\nend_header\n1\n",
    "huge count": b"ply\nformat binary_little_endian 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n1",
    "huge skipped count": b"ply\nformat binary_little_endian 1.0\nelement a 99999999999999\nproperty list uchar int i\n"
    b"element vertex 1\nproperty float x\nend_header\n1",
    "list in vertices": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n1 1\n",
    "stray property": b"ply\nformat ascii 1.0\nproperty float x\nend_header\n",
    "unknown line": b"ply\nformat ascii 1.0\nwhatever\nend_header\n",
    "words": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\na b c\n",
}


@pytest.mark.parametrize("name", BAD_HEADERS)
def test_bad_file_is_an_error_of_one_line(write, name):
    with pytest.raises(AddonError) as caught:
        read_ply(write("bad.ply", BAD_HEADERS[name]))
    assert "bad.ply" in str(caught.value) and "expected" in str(caught.value) and "\n" not in str(caught.value)


def test_missing_file_and_folder_are_errors(tmp_path):
    for path in (tmp_path / "absent.ply", tmp_path):
        with pytest.raises(AddonError, match="cannot read"):
            read_ply(str(path))


def test_windows_line_ends_are_read(write):
    data = our_ply(POSITIONS, order="").replace(b"\n", b"\r\n")
    np.testing.assert_array_equal(read_ply(write("dos.ply", data)).positions, POSITIONS)


def test_radius_is_estimated_from_how_densely_points_lie(write):
    rows = np.zeros(10_000, [(n, "f4") for n in "xyz"])
    positions = grid_positions(100, size=2.0)
    rows["x"], rows["y"] = positions[:, 0], positions[:, 1]
    radius = read_cloud(write("bare.ply", ply_bytes(rows))).radius[0]
    assert radius == pytest.approx((4.0 / 10_000 / np.pi) ** 0.5, rel=0.3)


def test_equal_points_have_some_radius(write):
    rows = np.zeros(5, [(n, "f4") for n in "xyz"])
    assert read_cloud(write("same.ply", ply_bytes(rows))).radius[0] > 0


def test_a_million_points_read_within_a_second(write):
    path = write("million.ply", our_ply(grid_positions(1000)))
    begin = time.process_time()
    assert len(read_cloud(path)) == 1_000_000
    assert time.process_time() - begin < 1.5
