# SPDX-License-Identifier: GPL-3.0-or-later
"""What only a Blender with a window does: panels are drawn, the operator runs beside the user, Esc stops it.

Run by run_suite.py under a virtual display; a timer plays the steps one after the other. Argument after --: a folder
for temporary files.
"""

import math
import os
import sys
import tempfile
import time
import traceback
from pathlib import Path

import addon_utils
import bpy
import numpy as np

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]
FOLDER = Path(sys.argv[sys.argv.index("--") + 1])
sys.path[:0] = [str(ROOT / "blender_addon"), str(HERE)]

from sample_files import our_ply

HEIGHT_OF_TRANSFORM_PANEL = 410
PROGRAM = """#!/usr/bin/python3
import json, sys, time
sys.path.insert(0, {here!r})
if sys.argv[1:] == ['--version']: print('vmap 0.1.0'); sys.exit()
if '--help' in sys.argv: print('--sky'); sys.exit()
def after(word): return sys.argv[sys.argv.index(word) + 1]
with open(after('--progress'), 'w') as f: f.write('{{"stage": "direct", "fraction": 0.5, "overall": 0.4}}\\n')
time.sleep({seconds})
from sample_files import our_ply
open(after('-o'), 'wb').write(our_ply([[0, 0, 0], [0.5, 0, 0]], irradiance=2.0))
json.dump({{'points': 2, 'seconds': {{'total': 0.5}}}}, open(after('--json'), 'w'))
"""


def use_program(seconds):
    path = FOLDER / "vmap"
    path.write_text(PROGRAM.format(here=str(HERE), seconds=seconds))
    path.chmod(0o755)
    bpy.context.preferences.addons["vmap"].preferences.program = str(path)


def view():
    """Window, 3D view and its main region, as keywords of a context override."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    return {"window": window, "area": area, "region": next(r for r in area.regions if r.type == "WINDOW")}


def steps():
    """Each yield lets Blender draw and handle events; a true value waits until it is called and says so."""
    from vmap.shell import light_operator

    window, area = view()["window"], view()["area"]
    window.workspace.status_text_set(None)
    area.spaces.active.show_region_ui = True
    yield
    if "VMAP_PICTURES" in os.environ:
        keep_picture_of_panel(area, "blender-panel.png", rows=450)
    print("ok: the panels are drawn")

    use_program(seconds=60)
    with bpy.context.temp_override(**view()):
        assert bpy.ops.vmap.light("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield lambda: light_operator.running() and "direct" in light_operator.running().status()
    run = light_operator.running()
    assert run.overall() == 0.4 and run.status().startswith("direct"), run.status()
    if "VMAP_PICTURES" in os.environ:
        yield
        keep_picture_of_panel(area, "blender-progress.png", rows=80)
    process = run.job._process
    begin = time.monotonic()
    window.event_simulate(type="ESC", value="PRESS", x=area.x + 50, y=area.y + 50)
    window.event_simulate(type="ESC", value="RELEASE", x=area.x + 50, y=area.y + 50)
    yield lambda: light_operator.running() is None
    seconds = time.monotonic() - begin
    assert seconds < 1 or "VMAP_PICTURES" in os.environ, seconds
    assert process.poll() is not None
    assert not list(Path(tempfile.gettempdir()).glob("vmap-*"))
    print(f"ok: Esc ended the program in {seconds:.2f} s")

    use_program(seconds=0.3)
    before = len(bpy.data.objects)
    with bpy.context.temp_override(**view()):
        assert bpy.ops.vmap.light("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield lambda: light_operator.running() is None
    assert len(bpy.data.objects) == before + 1 and bpy.context.object["vmap_result"] == "CLOUD"
    print("ok: the result arrives while the window lives")

    # A drop gives the folder and the names to invoke; no file selector opens.
    (FOLDER / "lit.ply").write_bytes(our_ply([[0, 0, 0]]))
    area.spaces.active.shading.type = "SOLID"
    with bpy.context.temp_override(**view()):
        result = bpy.ops.vmap.import_points("INVOKE_DEFAULT", directory=str(FOLDER), files=[{"name": "lit.ply"}])
    assert result == {"FINISHED"}, result
    assert area.spaces.active.shading.type == "MATERIAL"
    area.spaces.active.shading.type = "SOLID"
    print("ok: a dropped file is imported and its material shown")
    yield

    shown = eevee_picture()
    assert np.allclose(shown, [3.5 / math.pi, 0, 0], atol=2e-3), shown
    print("ok: EEVEE shows irradiance 3.5 on white as 3.5 / pi")


def eevee_picture():
    """Color of one big point, irradiance 3.5 on white, as EEVEE shows it."""
    from blender_helpers import look, render

    scene = bpy.data.scenes.new("eevee")
    bpy.context.window_manager.windows[0].scene = scene
    scene.render.engine = "BLENDER_EEVEE"
    scene.eevee.taa_render_samples = 1
    path = FOLDER / "one.ply"
    path.write_bytes(our_ply([[0, 0, 0]], irradiance=[3.5, 0, 0], albedo=1.0, radius=1.0))
    with bpy.context.temp_override(**view(), scene=scene):
        assert bpy.ops.vmap.import_points(filepath=str(path)) == {"FINISHED"}
        look(scene, (0, 0, 5), (0, 0, 0), ortho=0.5)
        return render(scene, FOLDER, 8)[3:5, 3:5, :3].mean(axis=(0, 1))


def keep_picture_of_panel(area, name, rows):
    """Our part of the sidebar, below Blender's own panel of the object, as a picture for the documentation."""
    from vmap.core.png import png_bytes

    whole = FOLDER / "window.png"
    bpy.ops.screen.screenshot(filepath=str(whole))
    image = bpy.data.images.load(str(whole), check_existing=False)
    pixels = np.array(image.pixels[:], np.float32).reshape(image.size[1], image.size[0], -1)
    bpy.data.images.remove(image)
    sidebar = next(r for r in area.regions if r.type == "UI")
    top = sidebar.y + sidebar.height - HEIGHT_OF_TRANSFORM_PANEL
    part = pixels[max(top - rows, sidebar.y) : top, sidebar.x : sidebar.x + sidebar.width - 20, :3][::-1]
    picture = png_bytes(np.rint(part * 255).astype(np.uint8))
    Path(os.environ["VMAP_PICTURES"], name).write_bytes(picture)


def show_our_tab():
    """Panels of other tabs are not drawn: ours go to the one that opens first."""
    from vmap.shell import panel

    for cls in panel.CLASSES:
        bpy.utils.unregister_class(cls)
        cls.bl_category = "Item"
        bpy.utils.register_class(cls)


class Player:
    def __init__(self):
        self.steps, self.wait, self.until = steps(), None, 0

    def __call__(self):
        try:
            if self.wait and not self.wait():
                assert time.monotonic() < self.until, "a step took longer than 20 s"
                return 0.05
            self.wait = next(self.steps)
            self.until = time.monotonic() + 20
            return 0.3 if self.wait is None else 0.05
        except StopIteration:
            finish(0)
        except BaseException:
            traceback.print_exc()
            finish(1)


def finish(code):
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


bpy.context.preferences.view.show_splash = False
addon_utils.enable("vmap", default_set=True)
show_our_tab()
bpy.app.timers.register(Player(), first_interval=0.5)
