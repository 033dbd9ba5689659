# SPDX-License-Identifier: GPL-3.0-or-later
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
# The folder of the add-on's package itself would pull in Blender; its core stands alone.
sys.path[:0] = [str(ROOT / "blender_addon" / "vmap"), str(ROOT / "tests" / "blender_addon")]


@pytest.fixture
def write(tmp_path):
    """Writes bytes or text to a file of this name and returns its path."""

    def write_file(name, data):
        path = tmp_path / name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return str(path)

    return write_file


@pytest.fixture
def fake_program(tmp_path):
    """A program of this Python body; sys, os, time are imported."""

    def make(body, name="vmap"):
        path = tmp_path / name
        path.write_text(f"#!{sys.executable}\nimport os, signal, sys, time\n{body}\n")
        path.chmod(0o755)
        return str(path)

    return make
