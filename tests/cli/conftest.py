# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the program in an empty folder."""

import json
import os
import struct
import subprocess
from base64 import b64encode
from pathlib import Path

import pytest

PROGRAM = os.environ["VMAP_PROGRAM"]
SCENES = Path(os.environ["VMAP_SCENES"])

OK, RUN_ERROR, USAGE, UNSUPPORTED, FILE_ERROR, COMPARISON_FAILED, INTERRUPTED, TERMINATED = 0, 1, 2, 3, 4, 5, 130, 143


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def vmap(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, timeout=60)


def succeed(*arguments):
    done = vmap(*arguments)
    assert done.returncode == OK, done.stderr.decode()
    return done


def scene(name):
    return SCENES / f"{name}.gltf"


def error_lines(done):
    """What a failed run says, without the warnings before it."""
    lines = done.stderr.decode().splitlines()
    assert all(line.startswith(("vmap: error: ", "vmap: warning: ")) for line in lines), lines
    return [line for line in lines if line.startswith("vmap: error: ")]


def content(folder):
    """Every file below the folder, hidden ones too, with its bytes."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def triangle(positions=((0, 0, 0), (1, 0, 0), (0, 1, 0)), **top_level):
    """A glTF file of one triangle in which nothing emits light."""
    data = b"".join(struct.pack("<3f", *p) for p in positions)
    uri = "data:application/octet-stream;base64," + b64encode(data).decode()
    gltf = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 3,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [1, 1, 0],
            }
        ],
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}],
        "buffers": [{"byteLength": len(data), "uri": uri}],
    }
    return json.dumps(gltf | top_level)
