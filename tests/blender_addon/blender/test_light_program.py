# SPDX-License-Identifier: GPL-3.0-or-later
"""Light this scene with programs that go wrong: an error with their last words, Blender alive, nothing left behind."""

import os
import time

import bpy
import pytest
from blender_helpers import add_light, add_plane, data_counts
from vmap.shell import light_operator, light_run
from vmap.shell.scene_settings import LightSettings

# A stand-in that lights nothing but writes what the real program would.
WORKING = """
sys.path.insert(0, {here!r})
import json
from sample_files import our_ply
out = [sys.argv[i + 1] for i, a in enumerate(sys.argv) if a == '-o']
for path in out:
    if path.endswith('.ply'): open(path, 'wb').write(our_ply([[0, 0, 0], [0.5, 0, 0]], irradiance=2.0))
report = {{'points': 2, 'seconds': {{'total': 0.5}}, 'warnings': ['specular is not modelled']}}
json.dump(report, open(sys.argv[sys.argv.index('--json') + 1], 'w'))
"""
HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
WORKING = WORKING.format(here=HERE)


@pytest.fixture(autouse=True)
def lit_scene(empty_scene):
    add_plane(empty_scene, "plane")
    add_light(empty_scene, "lamp", "POINT", 100, (0, 0, 1))


@pytest.mark.parametrize("body,text", [
    ("print('vmap: error: scene.glb: no light', file=sys.stderr); sys.exit(3)", "vmap: error: scene.glb: no light"),
    ("print('last words', file=sys.stderr, flush=True); os.kill(os.getpid(), signal.SIGSEGV)", "SIGSEGV: last words"),
    ("os.kill(os.getpid(), signal.SIGKILL)", "SIGKILL"),
    ("sys.stderr.buffer.write(bytes(range(256)) * 1000); sys.exit(1)", "ended with code 1"),
    ("pass", "report cannot be read"),
    (WORKING + "open(out[0], 'wb').write(b'garbage')", "begins with 'garbage'"),
    (WORKING + "os.remove(out[0])", "wrote no .ply file"),
])  # fmt: skip
def test_a_program_that_fails(fake_program, nothing_left, body, text):
    fake_program(body)
    with pytest.raises(RuntimeError, match=text):
        bpy.ops.vmap.light()
    assert light_operator.running() is None


def test_a_program_that_hangs_is_ended_by_the_time_limit(fake_program, nothing_left):
    fake_program("time.sleep(100)")
    begin = time.monotonic()
    with pytest.raises(RuntimeError, match="stopped after 0.5 s, the time limit"):
        bpy.ops.vmap.light(time_limit=0.5)
    assert time.monotonic() - begin < 5


@pytest.mark.parametrize("body", ["time.sleep(100)", "signal.signal(signal.SIGTERM, signal.SIG_IGN)\ntime.sleep(100)"])
def test_cancel_ends_the_run_within_a_second(fake_program, nothing_left, body):
    fake_program(body)
    run = light_run.LightRun(bpy.context, Settings())
    while run.job is None:
        run.step()
    wait_until(lambda: run.step() or time.monotonic() > begin + 0.4, begin := time.monotonic())
    begin = time.monotonic()
    run.cancel()
    with pytest.raises(Exception, match="cancelled"):
        wait_until(run.step, begin)
    run.close()
    assert time.monotonic() - begin < 1
    assert run.cancelled


def wait_until(done, begin):
    while not done():
        time.sleep(0.02)
        assert time.monotonic() - begin < 10


class Settings:
    """Properties as the panel has them, at their defaults."""

    result = {"CLOUD"}
    domain, tolerance, points, spacing, selected_only = "CORNER", 0.01, 0, 0.0, False
    use_frames, frame_start, frame_end, directory, time_limit = False, 1, 1, "", 0.0


def test_the_stand_in_for_the_settings_is_complete():
    assert all(hasattr(Settings, name) for name in LightSettings.__annotations__)


def test_missing_and_wrong_programs_say_what_to_do(nothing_left, monkeypatch, tmp_path):
    preferences = bpy.context.preferences.addons["vmap"].preferences
    monkeypatch.setenv("PATH", str(tmp_path))
    for path, text in (("", "no program"), ("/nowhere/vmap", "does not exist"), (str(tmp_path), "is a folder")):
        preferences.program = path
        with pytest.raises(RuntimeError, match=text):
            bpy.ops.vmap.light()
        with pytest.raises(RuntimeError, match=text):
            bpy.ops.vmap.check_program()


def test_the_right_program_is_confirmed(fake_program):
    fake_program("")
    assert bpy.ops.vmap.check_program() == {"FINISHED"}


def test_a_working_program_brings_a_cloud(fake_program):
    fake_program(WORKING)
    assert bpy.ops.vmap.light(tolerance=0.05, points=2) == {"FINISHED"}
    item = bpy.context.view_layer.objects.active
    assert item["vmap_result"] == "CLOUD" and item.name == "Scene_lit"
    before = data_counts()
    assert bpy.ops.vmap.light() == {"FINISHED"}  # the result of the first run gives way
    after = data_counts()
    assert (after["objects"], after["pointclouds"], after["meshes"]) == tuple(
        before[name] for name in ("objects", "pointclouds", "meshes"))  # fmt: skip


def test_an_animation_becomes_a_sequence_in_the_folder(fake_program, tmp_path, empty_scene):
    fake_program(WORKING)
    folder = tmp_path / "kept"
    assert bpy.ops.vmap.light(use_frames=True, frame_start=3, frame_end=5, directory=str(folder)) == {"FINISHED"}
    assert sorted(p.name for p in folder.iterdir()) == [f"Scene_lit_{frame:04d}.ply" for frame in (3, 4, 5)]
    item = bpy.context.view_layer.objects.active
    empty_scene.frame_set(4)
    assert item["vmap_sequence_shown"].endswith("Scene_lit_0004.ply") and len(item.data.vertices) == 2


def test_a_failing_frame_leaves_no_files_of_the_others(fake_program, nothing_left, tmp_path):
    counter = tmp_path / "counter"
    fake_program(WORKING + f"f = open({str(counter)!r}, 'a'); f.write('x'); f.close()\n"
                 f"if os.path.getsize({str(counter)!r}) == 2: sys.exit('second frame')")  # fmt: skip
    with pytest.raises(RuntimeError, match="second frame"):
        bpy.ops.vmap.light(use_frames=True, frame_start=1, frame_end=3, directory=str(tmp_path / "kept"))
    assert not (tmp_path / "kept").exists()


@pytest.mark.parametrize("arguments,text", [
    ({"result": set()}, "no result is chosen"),
    ({"points": 5, "spacing": 0.1}, "exclude each other"),
    ({"use_frames": True, "frame_start": 5, "frame_end": 4, "directory": "/tmp"}, "before the first"),
    ({"use_frames": True, "result": {"ATTRIBUTE"}}, "light of one frame"),
    ({"use_frames": True}, "save the .blend file first"),
    ({"result": {"VOLUME"}}, "save the .blend file first"),
])  # fmt: skip
def test_settings_that_do_not_fit_are_said(fake_program, nothing_left, arguments, text):
    fake_program(WORKING)
    with pytest.raises(RuntimeError, match=text):
        bpy.ops.vmap.light(**arguments)


def test_a_folder_that_cannot_be_made_is_said(fake_program, nothing_left):
    fake_program(WORKING)
    with pytest.raises(RuntimeError, match="/proc/nowhere"):
        bpy.ops.vmap.light(use_frames=True, frame_start=1, frame_end=2, directory="/proc/nowhere")


def test_edit_mode_is_said(fake_program, empty_scene):
    fake_program(WORKING)
    bpy.context.view_layer.objects.active = bpy.data.objects["plane"]
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Object Mode"):
        bpy.ops.vmap.light()
    bpy.ops.object.mode_set(mode="OBJECT")


def test_a_scene_without_surface_is_said(fake_program, nothing_left, empty_scene):
    fake_program(WORKING)
    bpy.data.objects["plane"].hide_render = True
    with pytest.raises(RuntimeError, match="nothing to light"):
        bpy.ops.vmap.light()


def test_progress_and_time_left_are_shown(fake_program):
    fake_program("""
path = sys.argv[sys.argv.index('--progress') + 1]
with open(path, 'w') as f: f.write('{"stage": "direct", "fraction": 0.5, "overall": 0.25}\\n')
time.sleep(60)
""")
    run = light_run.LightRun(bpy.context, Settings())
    begin = time.monotonic()
    assert run.status() == "reading the scene"
    while "direct" not in run.status():
        run.step()
        time.sleep(0.02)
        assert time.monotonic() - begin < 10
    assert run.overall() == 0.25 and "s left" in run.status()
    run.close()


def test_nothing_to_stop_is_said():
    assert bpy.ops.vmap.cancel() == {"CANCELLED"}
