# SPDX-License-Identifier: GPL-3.0-or-later
"""vmap build writes maps that are the same by every method, and vmap info and vmap compare tell what is in them."""

import json

import pytest
from conftest import ROOM, RULES, SCENES, refuse, run


def facts(file):
    return json.loads(run("info", file, "--json"))


def test_info_counts_nodes_leaves_links_and_bytes(room_map):
    told = facts(room_map)
    assert told["points"] == pytest.approx(8000, rel=0.05)
    assert told["source"] == ROOM.name
    assert told["rule"] == room_map.stem
    assert told["leaves"] == pytest.approx(500, rel=0.15)
    assert told["nodes"] > told["leaves"]
    assert told["n_squared"] == told["leaves"] ** 2
    assert told["decrease_percent"] == pytest.approx(100 * (1 - told["links"] / told["n_squared"]))
    assert 0 < told["links"] < told["visible_leaf_pairs"] < told["n_squared"]
    assert told["bytes"] == room_map.stat().st_size
    assert told["link_bytes"] == 4 * told["links"]
    assert told["seconds"]["vmap"] > 0
    low, high = told["box"]
    assert low[1] == pytest.approx(0, abs=1e-5) and high[1] == pytest.approx(5.488, abs=1e-5)


def test_info_as_text_has_a_line_for_each_fact(room_map):
    lines = run("info", room_map).splitlines()
    assert [line.split()[0] for line in lines] == list(facts(room_map))


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("method", ["exhaustive", "seed"])
def test_every_method_gives_the_map_of_the_fast_one(rule, method, maps, tmp_path):
    other = tmp_path / f"{method}.vmap"
    run("build", ROOM, "--points", 8000, "--leaves", 500, "--rule", rule, "--method", method, "-o", other)
    parts = dict(line.split() for line in run("compare", other, maps[rule]).splitlines())
    assert set(parts.values()) == {"same"}
    assert {"points", "nodes", "leaves", "links", "hidden_pairs"} <= set(parts)


def test_both_trees_are_built(tmp_path):
    for tree in ("adaptive", "uniform"):
        file = tmp_path / f"{tree}.vmap"
        run("build", ROOM, "--points", 2000, "--tree", tree, "-o", file)
        assert facts(file)["tree"] == tree


def test_the_number_of_threads_changes_no_byte_but_the_seconds(tmp_path, maps):
    one = tmp_path / "one.vmap"
    run("build", ROOM, "--points", 8000, "--leaves", 500, "--rule", "patch", "--threads", 1, "-o", one)
    run("compare", one, maps["patch"])


def test_compare_tells_what_differs(maps, tmp_path):
    coarse = tmp_path / "coarse.vmap"
    run("build", ROOM, "--points", 8000, "--leaves", 100, "-o", coarse)
    report = tmp_path / "report.json"
    line = refuse(5, "compare", coarse, maps["centroid"], "--json", report, "--quiet")
    assert "leaves" in line and "points" not in line
    parts = json.loads(report.read_text())
    assert parts["points"] == "same"
    assert parts["links"] != "same"


def test_the_report_has_counts_and_seconds(tmp_path):
    output = tmp_path / "room.vmap"
    report = json.loads(run("build", ROOM, "--points", 2000, "--rule", "patch", "-o", output, "--json", "-"))
    told = facts(output)
    for key in ("points", "nodes", "leaves", "patches", "links"):
        assert report[key] == told[key], key
    assert report["seconds"]["vmap"] > 0
    assert report["outputs"] == [str(output)]


def test_what_cannot_be_built_is_refused_and_leaves_no_file(tmp_path):
    output = tmp_path / "out.vmap"
    garbage = tmp_path / "garbage.glb"
    garbage.write_bytes(b"glTF but not really")
    assert "absent.glb" in refuse(4, "build", tmp_path / "absent.glb", "-o", output)
    refuse(4, "build", garbage, "-o", output)
    refuse(4, "build", ROOM, "-o", tmp_path / "no folder" / "out.vmap")
    for options in (["--leaves", "0"], ["--cell-size", "-1"], ["--points-per-leaf", "0"], ["--method", "guess"],
                    ["--rule", "none"], ["--tree", "binary"], ["--leaves", "10", "--cell-size", "1"],
                    ["--points", "2000", "--tree", "uniform", "--cell-size", "1e-9"]):
        refuse(2, "build", ROOM, "-o", output, *options)
    refuse(2, "build", ROOM)
    refuse(2, "build", garbage, "-o", garbage)
    refuse(2, "build", ROOM, "-o", output, "--json", output)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["garbage.glb"]


def test_an_output_that_exists_stays_when_the_job_fails(tmp_path):
    output = tmp_path / "out.vmap"
    output.write_text("precious")
    refuse(4, "build", tmp_path / "absent.glb", "-o", output)
    assert output.read_text() == "precious"


def test_compare_refuses_what_is_no_pair_of_maps(maps):
    refuse(2, "compare", maps["patch"], ROOM)
    refuse(2, "compare", maps["patch"], maps["patch"], "--max-mean", 0.1)
    refuse(2, "compare", maps["patch"], maps["patch"], "--html", "-")


def damaged_files(good):
    """Names and contents that are no .vmap file any more."""
    data = bytearray(good)
    yield "empty", b""
    yield "cut", good[: len(good) // 2]
    yield "one byte short", good[:-1]
    yield "longer", good + b"\0"
    for place in (9, 20, 40, 64, len(good) // 3, len(good) - 3):
        flipped = data.copy()
        flipped[place] ^= 4
        yield f"flipped {place}", bytes(flipped)
    huge = data.copy()
    huge[40:48] = (2**60).to_bytes(8, "little")  # size of the first chunk
    yield "huge chunk", bytes(huge)


def test_damaged_maps_are_refused_by_every_command(maps, tmp_path):
    for name, content in damaged_files(maps["patch"].read_bytes()):
        file = tmp_path / f"{name}.vmap"
        file.write_bytes(content)
        code = 4 if content.startswith(b"VMAP") else None
        if code is None:
            continue
        assert file.name in refuse(4, "info", file)
        assert file.name in refuse(4, "query", file, "--sees", 0, 1)
        assert file.name in refuse(4, "compare", file, maps["patch"])


def test_a_map_of_another_version_is_named_as_such(maps, tmp_path):
    data = bytearray(maps["centroid"].read_bytes())
    data[8:12] = (99).to_bytes(4, "little")
    file = tmp_path / "future.vmap"
    file.write_bytes(data)
    assert "version 99" in refuse(4, "info", file)


def test_a_scene_without_a_surface_is_refused(tmp_path):
    bare = tmp_path / "bare.gltf"
    bare.write_text(json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0}))
    refuse(3, "build", bare, "-o", tmp_path / "out.vmap")
    assert SCENES.is_dir() and not (tmp_path / "out.vmap").exists()
