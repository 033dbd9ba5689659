# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on as users get it: a zip file that Blender installs itself."""

import os
import shutil
import subprocess
import sys

import addon_utils
import bpy
import pytest
from blender_helpers import ROOT
from sample_files import our_ply


@pytest.fixture
def zips(tmp_path):
    """Paths of the extension and of the add-on for older versions."""
    command = ["/usr/bin/python3", str(ROOT / "blender_addon" / "package.py"), "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    addon_utils.disable("vmap", default_set=True)
    loaded = {name: sys.modules.pop(name) for name in list(sys.modules) if name.split(".")[0] == "vmap"}
    yield done.stdout.split()
    sys.modules.update(loaded)


def works(path):
    assert bpy.ops.vmap.import_points(filepath=path) == {"FINISHED"}
    with pytest.raises(RuntimeError, match="no program|vmap"):
        bpy.ops.vmap.check_program()


def test_as_an_add_on_of_the_old_kind(zips, write, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(sys, "path", [p for p in sys.path if "blender_addon" not in p])
    bpy.ops.preferences.addon_install(filepath=zips[1])
    assert bpy.ops.preferences.addon_enable(module="vmap") == {"FINISHED"}
    try:
        assert "scripts/addons" in sys.modules["vmap"].__file__.replace("\\", "/")
        works(write("lit.ply", our_ply([[0, 0, 0]])))
    finally:
        folder = os.path.dirname(sys.modules["vmap"].__file__)
        addon_utils.disable("vmap", default_set=True)
        shutil.rmtree(folder)


@pytest.mark.skipif(not hasattr(bpy.ops, "extensions") or bpy.app.version < (4, 2), reason="no extensions before 4.2")
def test_as_an_extension(zips, write, monkeypatch):
    monkeypatch.setenv("PATH", "")
    bpy.ops.extensions.package_install_files(repo="user_default", filepath=zips[0], enable_on_install=True)
    module = "bl_ext.user_default.vmap"
    assert module in bpy.context.preferences.addons
    try:
        assert bpy.context.preferences.addons[module].preferences.program == ""
        works(write("lit.ply", our_ply([[0, 0, 0]])))
    finally:
        addon_utils.disable(module, default_set=True)
        bpy.ops.extensions.package_uninstall(repo_index=1, pkg_id="vmap")
