# SPDX-License-Identifier: GPL-3.0-or-later
"""What cannot be done: the documented exit code, one line that says why, and every file as it was."""

import math
import os

import pytest
from conftest import COMPARISON_FAILED, FILE_ERROR, UNSUPPORTED, USAGE, content, error_lines, scene, succeed, triangle, vmap


def assert_refused(folder, code, named, expected, *arguments):
    before = content(folder)
    done = vmap(*arguments)
    assert done.returncode == code, done.stderr.decode()
    assert done.stdout == b""
    (line,) = error_lines(done)
    assert named in line and expected in line
    assert content(folder) == before


@pytest.fixture
def old_result(folder):
    (folder / "lit.ply").write_bytes(b"an old result")
    return folder


def refuse_light(folder, code, text, expected, name="scene.gltf"):
    (folder / name).write_text(text)
    assert_refused(folder, code, name, expected, "light", name, "-o", "lit.ply", "-o", "lit.vdb", "--json", "r.json")


def test_missing_file(old_result):
    assert_refused(old_result, FILE_ERROR, "nowhere.glb", "No such file", "light", "nowhere.glb", "-o", "lit.ply")


def test_folder_as_input(old_result):
    (old_result / "room.glb").mkdir()
    assert_refused(old_result, FILE_ERROR, "room.glb", "expected a file", "light", "room.glb", "-o", "lit.ply")


def test_scene_without_surface(old_result):
    refuse_light(old_result, UNSUPPORTED, '{"asset": {"version": "2.0"}, "scenes": [{}], "scene": 0}', "neither surface")


def test_scene_without_light(old_result):
    refuse_light(old_result, UNSUPPORTED, triangle(), "emit")


def test_unknown_required_extension(old_result):
    text = triangle(extensionsUsed=["ACME_rays"], extensionsRequired=["ACME_rays"])
    refuse_light(old_result, UNSUPPORTED, text, "ACME_rays")


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_positions_that_are_no_numbers(old_result, bad):
    refuse_light(old_result, FILE_ERROR, triangle(((0, 0, 0), (1, bad, 0), (0, 1, 0))), "finite")


def test_text_that_is_no_gltf(old_result):
    refuse_light(old_result, FILE_ERROR, "{ this is not JSON", "JSON")


def test_file_of_unknown_kind(old_result):
    refuse_light(old_result, UNSUPPORTED, "hello", "expected", name="scene.blend")


@pytest.mark.parametrize("option", [("--points", "0"), ("--spacing", "0"), ("--spacing", "-1"), ("--spacing", "nan")])
def test_no_points(old_result, option):
    assert_refused(old_result, USAGE, "furnace_50", "expected", "light", scene("furnace_50"), "-o", "lit.ply", *option)


@pytest.mark.parametrize(
    "arguments, expected",
    [
        (("--points", "-5"), "expected 1 or more"),
        (("--points", "many"), "many"),
        (("--up", "x"), "expected one of y, z"),
        (("--light", "point:1,2:3"), "--light"),
        (("--size", "0x10"), "expected"),
        (("--threads", "-1"), "--threads"),
        (("--no-such-option",), "--no-such-option"),
    ],
)
def test_option_that_makes_no_sense(old_result, arguments, expected):
    lit = ("light", scene("furnace_50"), "-o", "lit.ply", "-o", "lit.png", "--points", "500")
    lit = lit[:-2] if arguments[0] == "--points" else lit
    assert_refused(old_result, USAGE, arguments[0], expected, *lit, *arguments)


def test_unknown_command(folder):
    assert_refused(folder, USAGE, "'paint'", "light", "paint", "scene.glb")


def test_no_command(folder):
    assert_refused(folder, USAGE, "", "--help")


@pytest.mark.parametrize("command", ["light", "sample"])
def test_unknown_output_format(old_result, command):
    lit = (command, scene("furnace_50"), "-o", "lit.ply", "-o", "lit.xyzzy")
    assert_refused(old_result, USAGE, "lit.xyzzy", "expected .ply", *lit)


def test_output_folder_that_does_not_exist(old_result):
    lit = ("light", scene("furnace_50"), "-o", "lit.ply", "-o", "nowhere/lit.ply")
    assert_refused(old_result, FILE_ERROR, "nowhere/lit.ply", "No such file", *lit)


def test_folder_as_output(old_result):
    (old_result / "out.vdb").mkdir()
    lit = ("light", scene("furnace_50"), "-o", "lit.ply", "-o", "out.vdb")
    assert_refused(old_result, FILE_ERROR, "out.vdb", "Is a directory", *lit)


def test_output_where_nobody_may_write(folder):
    assert_refused(folder, FILE_ERROR, "/proc/lit.ply", "cannot create", "light", scene("furnace_50"), "-o", "/proc/lit.ply")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_read_only_output(old_result):
    (old_result / "lit.ply").chmod(0o444)
    lit = ("light", scene("furnace_50"), "-o", "lit.ply")
    assert_refused(old_result, FILE_ERROR, "lit.ply", "Permission denied", *lit)


@pytest.mark.parametrize("spelling", ["room.gltf", "./room.gltf", "link.gltf", "hard/../room.gltf"])
def test_output_over_the_input(folder, spelling):
    (folder / "room.gltf").write_bytes(scene("furnace_50").read_bytes())
    (folder / "link.gltf").symlink_to("room.gltf")
    (folder / "hard").mkdir()
    assert_refused(folder, USAGE, spelling, "is an input", "light", "room.gltf", "-o", "lit.ply", "-o", spelling)


@pytest.mark.parametrize(
    "arguments",
    [("-o", "a.ply", "-o", "./a.ply"), ("-o", "a.ply", "--json", "a.ply"), ("-o", "-", "--json", "-")],
)
def test_one_file_for_two_outputs(folder, arguments):
    assert_refused(folder, USAGE, arguments[-1], "named twice", "light", scene("furnace_50"), *arguments)


def test_pictures_and_exports_of_what_is_not_there(folder):
    assert_refused(folder, FILE_ERROR, "lit.ply", "No such file", "render", "lit.ply", "-o", "lit.png")
    assert_refused(folder, FILE_ERROR, "room.glb", "No such file", "export", "room.glb", "-o", "room.pov")
    assert_refused(folder, FILE_ERROR, "a.exr", "No such file", "compare", "a.exr", "b.exr", "--html", "report.html")
    assert_refused(folder, FILE_ERROR, "room.glb", "No such file", "info", "room.glb")


def test_picture_of_a_scene_that_was_not_lit(folder):
    assert_refused(folder, UNSUPPORTED, "furnace_50", "vmap light", "render", scene("furnace_50"), "-o", "a.png")


def test_picture_over_the_points(folder):
    succeed("light", scene("furnace_50"), "-o", "lit.ply", "--points", 500)
    os.symlink("lit.ply", "lit.png")
    assert_refused(folder, USAGE, "lit.png", "is an input", "render", "lit.ply", "-o", "lit.png")


def test_export_to_an_unknown_format(folder):
    assert_refused(folder, USAGE, "room.blend", "expected", "export", scene("furnace_50"), "-o", "room.blend")


def test_export_into_a_missing_folder(folder):
    lit = ("export", scene("sphere_room"), "-o", "nowhere/room.pov")
    assert_refused(folder, FILE_ERROR, "nowhere/room.pov", "No such file", *lit)


def test_comparison_that_fails_keeps_its_report(folder):
    for name, light in (("a", "1"), ("b", "2")):
        light = f"point:0,0,0:{light}"
        succeed("light", scene("furnace_50"), "-o", f"{name}.ply", "--points", 500, "--light", light)
    done = vmap("compare", "a.ply", "b.ply", "--max-mean", "1e-6", "--html", "report.html")
    assert done.returncode == COMPARISON_FAILED
    (line,) = error_lines(done)
    assert "a.ply" in line and "b.ply" in line and "mean" in line
    assert (folder / "report.html").stat().st_size > 0
