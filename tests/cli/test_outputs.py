# SPDX-License-Identifier: GPL-3.0-or-later
"""Every output on a bundled scene: the same bytes at any number of threads, and one job after the other works on them."""

import pytest
from conftest import COMPARISON_FAILED, content, scene, succeed, vmap

FORMATS = ("lit.ply", "lit.glb", "lit.gltf", "lit.vdb", "lit.exr", "lit.png")
UUID = slice(22, 58)  # OpenVDB writes a random one into its header


def comparable(files):
    masked = {}
    for name, data in files.items():
        masked[name] = data[: UUID.start] + data[UUID.stop :] if name.endswith(".vdb") else data
    return masked


def outputs(*names):
    return [argument for name in names for argument in ("-o", name)]


def files_at(folder, threads, *arguments):
    here = folder / f"threads_{threads}"
    here.mkdir()
    names = [here / name for name in arguments[-1]]
    succeed(*arguments[:-1], "--threads", threads, *outputs(*names))
    return comparable(content(here))


@pytest.mark.parametrize("name", ["cornell_box", "sphere_room", "spot_light_soft"])
def test_light_gives_the_same_bytes_at_any_number_of_threads(folder, name):
    lit = ("light", scene(name), "--points", 5000, "--size", 96, FORMATS)
    alone = files_at(folder, 1, *lit)
    assert set(alone) == set(FORMATS)
    assert files_at(folder, 2, *lit) == alone
    assert files_at(folder, 8, *lit) == alone


def test_vdb_points_are_the_same_bytes_at_any_number_of_threads(folder):
    lit = ("light", scene("cornell_box"), "--points", 5000, "--vdb", "points", ("lit.vdb",))
    assert files_at(folder, 8, *lit) == files_at(folder, 1, *lit)


def test_exports_and_pictures_are_the_same_bytes_at_any_number_of_threads(folder):
    succeed("light", scene("sphere_room"), "--points", 5000, "-o", "lit.ply")
    drawn = ("render", "lit.ply", "--scene", scene("sphere_room"), "--size", 96, ("a.exr", "a.png"))
    assert files_at(folder, 8, *drawn) == files_at(folder, 1, *drawn)
    for threads in (1, 8):
        (folder / f"pov_{threads}").mkdir()
        for source in (scene("sphere_room"), "lit.ply"):
            target = folder / f"pov_{threads}" / f"{'points' if source == 'lit.ply' else 'scene'}.pov"
            succeed("export", source, "-o", target, "--threads", threads)
    assert content(folder / "pov_8") == content(folder / "pov_1")


def test_the_seed_decides(folder):
    for seed in (1, 2):
        succeed("sample", scene("furnace_50"), "--points", 1000, "--seed", seed, "-o", f"{seed}.ply")
    succeed("sample", scene("furnace_50"), "--points", 1000, "-o", "again.ply")
    files = content(folder)
    assert files["again.ply"] == files["1.ply"]
    assert files["2.ply"] != files["1.ply"]


def test_standard_output_holds_the_points_and_nothing_else(folder):
    lit = ("light", scene("furnace_50"), "--points", 500)
    succeed(*lit, "-o", "lit.ply")
    piped = succeed(*lit, "-o", "-", "-v")
    assert piped.stdout == (folder / "lit.ply").read_bytes()
    assert set(content(folder)) == {"lit.ply"}


def test_new_results_replace_old_ones_only_together(folder):
    (folder / "lit.ply").write_bytes(b"old")
    (folder / "lit.exr").write_bytes(b"old")
    succeed("light", scene("furnace_50"), "--points", 500, "--size", 16, *outputs("lit.ply", "lit.exr"))
    assert all(data != b"old" for data in content(folder).values())
    assert set(content(folder)) == {"lit.ply", "lit.exr"}


def test_the_chain_of_light_render_export_compare(folder):
    """A picture made at once and one made later from the file of points are the same picture."""
    light = ("light", scene("cornell_box"), "--points", 20000, "--size", 128)
    succeed(*light, *outputs("lit.ply", "at_once.exr", "at_once.png"))
    succeed("render", "lit.ply", "--scene", scene("cornell_box"), "--size", 128, *outputs("later.exr", "later.png"))
    same = succeed("compare", "later.exr", "at_once.exr", "--max-mean", "1e-4", "--html", "page.html")
    assert b"mean" in same.stdout and b"pixels" in same.stdout
    page = (folder / "page.html").read_text()
    assert "<html" in page and "http://" not in page.replace("http://www.w3.org", "")

    succeed("export", scene("cornell_box"), "-o", "box.pov", "--size", 128, "--preset", "draft")
    assert "mesh2" in (folder / "box.pov").read_text()
    succeed("export", "lit.ply", "-o", "points.pov")

    succeed(*light, *outputs("coarse.ply"), "--tolerance", "0.2", "--seed", 3)
    close = vmap("compare", "coarse.ply", "lit.ply", "--max-mean", "0.2")
    assert close.returncode == 0, close.stderr.decode()
    assert vmap("compare", "coarse.ply", "lit.ply", "--max-mean", "1e-9").returncode == COMPARISON_FAILED


def test_points_of_our_own_files_can_be_lit_again(folder):
    succeed("sample", scene("cornell_box"), "--points", 3000, "-o", "points.ply")
    succeed("light", "points.ply", "-o", "from_points.ply")
    succeed("light", scene("cornell_box"), "--points", 3000, "-o", "from_scene.ply")
    succeed("compare", "from_points.ply", "from_scene.ply", "--max-mean", "0.01")


def test_a_camera_is_placed_where_the_scene_has_none(folder):
    succeed("light", scene("cornell_box"), "--points", 3000, "-o", "lit.ply")
    done = succeed("render", "lit.ply", "--size", "48x32", "-o", "a.png")
    assert b"vmap: warning: no camera" in done.stderr
    succeed("render", "lit.ply", "--camera", "0,0,3,0,0,0,40", "--size", "48x32", "-o", "b.png")
    succeed("render", "lit.ply", "--camera", scene("cornell_box"), "--size", "48x32", "-o", "c.png")


def test_files_that_do_not_fit_the_disk_are_an_error_and_leave_nothing(folder):
    (folder / "full.ply").symlink_to("/dev/full")
    done = vmap("light", scene("furnace_50"), "--points", 500, *outputs("lit.exr", "full.ply"))
    assert done.returncode == 4
    assert b"full.ply" in done.stderr and b"No space" in done.stderr
    assert [p.name for p in folder.iterdir()] == ["full.ply"]
