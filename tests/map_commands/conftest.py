# SPDX-License-Identifier: GPL-3.0-or-later
"""The program, and maps of one room under both rules that the tests share."""

import os
import subprocess
from pathlib import Path

import pytest

SCENES = Path(__file__).parents[2] / "scenes"
ROOM = SCENES / "cornell_box.gltf"
RULES = ("centroid", "patch")


def run(*arguments, stdin="", expect=0):
    """Runs the program and returns its standard output; what it says when it fails is one line."""
    command = [os.environ["VMAP_PROGRAM"], *map(str, arguments)]
    done = subprocess.run(command, input=stdin, capture_output=True, text=True, timeout=120)
    assert done.returncode == expect, f"{command}: {done.returncode}, expected {expect}\n{done.stderr}"
    return done.stdout


def refuse(code, *arguments, stdin="", stdout=""):
    """Runs the program, which refuses with this exit code and one line; returns the line."""
    command = [os.environ["VMAP_PROGRAM"], *map(str, arguments)]
    done = subprocess.run(command, input=stdin, capture_output=True, text=True, timeout=120)
    assert done.returncode == code, f"{command}: {done.returncode}, expected {code}\n{done.stderr}"
    assert done.stdout == stdout
    errors = [line for line in done.stderr.splitlines() if not line.startswith("vmap: warning: ")]
    assert len(errors) == 1, done.stderr
    assert errors[0].startswith("vmap: error: ")
    return errors[0]


@pytest.fixture(scope="session")
def maps(tmp_path_factory):
    """Maps of the Cornell box under both rules, by rule."""
    folder = tmp_path_factory.mktemp("maps")
    files = {rule: folder / f"{rule}.vmap" for rule in RULES}
    for rule, file in files.items():
        run("build", ROOM, "--points", 8000, "--leaves", 500, "--rule", rule, "-o", file)
    return files


@pytest.fixture(params=RULES)
def room_map(request, maps):
    """One of them after the other."""
    return maps[request.param]
