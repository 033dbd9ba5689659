# SPDX-License-Identifier: GPL-3.0-or-later
"""What programs that call ours read: reports, progress, versions and help."""

import json
import re

import pytest
from conftest import scene, succeed, vmap

COMMANDS = ("light", "sample", "info", "build", "query", "render", "export", "compare")
FIELDS = {
    "version", "input", "seed", "threads", "points", "nodes", "leaves", "patches", "links", "lights", "seconds",
    "tolerance", "error_estimate", "mean_irradiance", "peak_memory_bytes", "warnings", "outputs",
}  # fmt: skip
STAGES = {"import", "sample", "tree", "vmap", "direct", "indirect", "write", "total"}


def test_report_of_light_has_the_documented_fields(folder):
    lit = ("light", scene("cornell_box"), "--points", 3000, "--seed", 5, "--threads", 2, "--tolerance", 0.02)
    succeed(*lit, "-o", "lit.ply", "-o", "lit.vdb", "--json", "report.json")
    report = json.loads((folder / "report.json").read_text())
    assert FIELDS <= set(report)
    assert STAGES <= set(report["seconds"])
    assert all(seconds >= 0 for seconds in report["seconds"].values())
    assert report["seconds"]["total"] > 0
    assert report["points"] == 3000
    assert (report["seed"], report["threads"], report["tolerance"]) == (5, 2, 0.02)
    assert report["input"].endswith("cornell_box.gltf")
    assert report["outputs"] == ["lit.ply", "lit.vdb"]
    assert report["leaves"] > 0 and report["nodes"] > 0
    assert {"mean", "p95"} <= set(report["error_estimate"])
    assert 0 < report["mean_irradiance"] < 100
    assert 1e6 < report["peak_memory_bytes"] < 4e9


def test_report_repeats_the_warnings(folder):
    done = succeed("light", scene("cornell_box"), "--points", 500, "-o", "lit.ply", "--json", "report.json")
    said = [line.removeprefix("vmap: warning: ") for line in done.stderr.decode().splitlines()]
    assert json.loads((folder / "report.json").read_text())["warnings"] == said


def test_report_on_standard_output(folder):
    done = succeed("light", scene("furnace_50"), "--points", 500, "-o", "lit.ply", "--json", "-")
    assert json.loads(done.stdout)["points"] == 500


def test_report_of_sample(folder):
    succeed("sample", scene("furnace_50"), "--points", 500, "-o", "points.ply", "--json", "report.json")
    report = json.loads((folder / "report.json").read_text())
    assert report["points"] == 500 and report["outputs"] == ["points.ply"]


def test_info_as_json(folder):
    facts = json.loads(succeed("info", scene("cornell_box"), "--json").stdout)
    assert facts["triangles"] > 0 and facts["cameras"] == 1


def test_figures_of_a_comparison_as_json(folder):
    succeed("light", scene("furnace_50"), "--points", 500, "-o", "lit.ply")
    figures = json.loads(succeed("compare", "lit.ply", "lit.ply", "--json", "-").stdout)
    assert figures["mean"] == 0


def test_progress_file_has_one_object_per_line(folder):
    succeed("light", scene("cornell_box"), "--points", 5000, "-o", "lit.ply", "--progress", "progress")
    lines = [json.loads(line) for line in (folder / "progress").read_text().splitlines()]
    assert {"import", "sample", "write"} <= {line["stage"] for line in lines}
    overall = [line["overall"] for line in lines]
    assert overall == sorted(overall) and 0 <= overall[0] and overall[-1] <= 1


def test_nothing_is_said_without_a_reason(folder):
    lit = ("light", scene("cornell_box"), "--points", 500, "-o", "lit.ply")
    assert succeed(*lit, "--quiet").stderr == b""
    assert b"%" not in succeed(*lit).stderr  # no bar where there is no terminal
    assert b"500 points" in succeed(*lit, "-v").stderr


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_an_example(folder, command):
    text = succeed(command, "--help").stdout.decode()
    assert f"Example: vmap {command} " in text


def test_main_help_lists_commands_and_exit_codes(folder):
    text = succeed("--help").stdout.decode()
    assert all(command in text for command in COMMANDS)
    assert all(code in text for code in ("130 interrupted", "143 terminated", "2 usage", "4 file error"))


def test_version(folder):
    assert re.fullmatch(rb"vmap \d+\.\d+\.\d+\n", succeed("--version").stdout)
    assert vmap("--version").stderr == b""


def test_info_tells_what_is_in_a_scene_and_what_light_would_do(folder):
    facts = json.loads(succeed("info", scene("spot_light_hard"), "--json").stdout)
    assert (facts["format"], facts["up"]) == ("glTF, text", "y")
    assert facts["lights"] == len(facts["light_list"]) == 1
    light = facts["light_list"][0]
    assert light["kind"] == "spot" and len(light["position"]) == len(light["direction"]) == 3
    assert 0 < light["cone_degrees"][0] <= light["cone_degrees"][1] <= 90
    assert facts["extensions"] == ["KHR_lights_punctual"]
    assert facts["area"] > 0 and facts["triangles"] > 0 and facts["vertices"] > 0
    assert all(low <= high for low, high in zip(*facts["box"]))
    assert any("sample 200000 points" in step for step in facts["light_would"])
    assert any("1 light" in step for step in facts["light_would"])


def test_info_tells_what_is_missing(folder):
    (folder / "scan.xyz").write_text("0 0 0\n1 0 0\n0 1 0\n1 1 0\n")
    facts = json.loads(succeed("info", "scan.xyz", "--json").stdout)
    assert facts["points"] == 4 and facts["point_attributes"] == [] and facts["up"] == "z"
    assert "normals" in facts["light_would"][0] and "refuse: nothing emits light" in facts["light_would"][-1]


def test_info_of_lit_points(folder):
    succeed("light", scene("cornell_box"), "--points", 500, "-o", "lit.ply", "--quiet")
    facts = json.loads(succeed("info", "lit.ply", "--json").stdout)
    assert {"normal", "area", "albedo", "emission", "irradiance"} <= set(facts["point_attributes"])
    assert facts["emissive_area"] > 0 and facts["area"] > 100
    assert facts["light_would"][0] == "take the points as they are"


def test_info_for_people_has_a_line_for_each_fact(folder):
    lines = succeed("info", scene("cornell_box")).stdout.decode().splitlines()
    assert any(line.startswith("format ") and line.endswith("glTF, text") for line in lines)
    assert any(line.startswith("light_would ") for line in lines)


def test_info_warns_once_for_each_feature(folder):
    (folder / "two.mtl").write_text("newmtl a\nKs 1 1 1\nnewmtl b\nKs 1 1 1\n")
    (folder / "two.obj").write_text("mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n")
    facts = json.loads(succeed("info", "two.obj", "--json", "--quiet").stdout)
    assert sum("specular" in warning for warning in facts["warnings"]) == 1
