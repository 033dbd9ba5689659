# SPDX-License-Identifier: GPL-3.0-or-later
import os
import sys
from pathlib import Path

import addon_utils
import bpy
import pytest
from blender_helpers import ROOT, data_counts

os.environ.setdefault("VMAP_PROGRAM", str(ROOT / "build" / "release" / "bin" / "vmap"))


@pytest.fixture(autouse=True)
def empty_scene():
    """Every test begins with an empty file and the add-on enabled."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_utils.enable("vmap", default_set=True)
    bpy.context.scene.render.threads_mode = "FIXED"
    bpy.context.scene.render.threads = 2
    bpy.context.preferences.addons["vmap"].preferences.program = ""
    yield bpy.context.scene


@pytest.fixture
def write(tmp_path):
    """Writes bytes or text to a file of this name and returns its path."""

    def write_file(name, data):
        path = tmp_path / name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return str(path)

    return write_file


@pytest.fixture
def nothing_left(tmp_path, monkeypatch):
    """Fails when the test adds data to the file or leaves something in the temporary folder."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    before = data_counts()
    yield
    assert data_counts() == before
    assert list(folder.iterdir()) == []


@pytest.fixture
def fake_program(tmp_path):
    """Sets the add-on's program to one of this Python body, run for `vmap light`; the rest is as the real one."""

    def make(body):
        path = tmp_path / "vmap"
        python = sys.executable if "python" in Path(sys.executable).name else "/usr/bin/python3"
        path.write_text(
            f"#!{python}\nimport os, signal, sys, time\n"
            "if sys.argv[1:] == ['--version']: print('vmap 0.1.0'); sys.exit()\n"
            "if '--help' in sys.argv: print('--sky'); sys.exit()\n"
            f"{body}\n"
        )
        path.chmod(0o755)
        bpy.context.preferences.addons["vmap"].preferences.program = str(path)
        return str(path)

    return make


@pytest.fixture
def program():
    """The real program; without it the test is skipped, loudly."""
    path = os.environ["VMAP_PROGRAM"]
    if not os.access(path, os.X_OK):
        pytest.skip(f"SKIPPED: no program at {path}")
    bpy.context.preferences.addons["vmap"].preferences.program = path
    return path
