# SPDX-License-Identifier: GPL-3.0-or-later
"""Light this scene: blocks in a script, runs beside the user from the panel."""

import time

import bpy

from ..core.errors import AddonError
from .light_run import LightRun
from .scene_settings import LightSettings

_runs = []  # the one that the panel shows, if any
PAUSE = 0.02
TIMER = 0.1


def running():
    return _runs[0] if _runs else None


class VMAP_OT_light(bpy.types.Operator, LightSettings):
    """Light the scene with the vmap program and bring the light back. Esc stops it"""

    bl_idname = "vmap.light"
    bl_label = "Light this scene"
    bl_options = {"UNDO"}

    def invoke(self, context, _event):
        settings = context.scene.vmap_light
        for name in LightSettings.__annotations__:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(settings, name))
        if bpy.app.background or context.window is None:
            return self.execute(context)
        run = self._start(context)
        if run is None:
            return {"CANCELLED"}
        self._timer = context.window_manager.event_timer_add(TIMER, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        run = running()
        if event.type == "ESC" and run:
            run.cancel()
        if event.type not in {"TIMER", "ESC"}:
            return {"PASS_THROUGH"}
        _redraw(context)
        if run.cancelled:
            return self._finish(context, run)  # takes half a second at most
        try:
            done = run.step()
        except BaseException as error:
            return self._end(context, error)
        return self._end(context) if done else {"RUNNING_MODAL"}

    def execute(self, context):
        run = self._start(context)
        return self._finish(context, run) if run else {"CANCELLED"}

    def _finish(self, context, run):
        """Does all that is left before it returns."""
        try:
            while not run.step():
                time.sleep(PAUSE)
        except BaseException as error:
            return self._end(context, error)
        return self._end(context)

    def cancel(self, context):
        """Blender itself ends the operator, for instance because it quits."""
        self._end(context, AddonError("cancelled"))

    def _start(self, context):
        if running():
            self.report({"ERROR"}, "The scene is being lit already")
            return None
        try:
            run = LightRun(context, self)
        except AddonError as error:
            self.report({"ERROR"}, str(error))
            return None
        _runs.append(run)
        return run

    def _end(self, context, error=None):
        run = _runs.pop()
        run.close()
        if getattr(self, "_timer", None):
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
            _redraw(context)
        for kind, line in run.notes:
            self.report({kind}, line)
        if error is None:
            return {"FINISHED"}
        if not isinstance(error, AddonError):
            raise error
        if run.cancelled:
            self.report({"WARNING"}, "Cancelled")
        else:
            self.report({"ERROR"}, "\n".join([str(error), *getattr(error, "lines", ())]))
        return {"CANCELLED"}


class VMAP_OT_cancel(bpy.types.Operator):
    """Stop lighting the scene"""

    bl_idname = "vmap.cancel"
    bl_label = "Stop"

    def execute(self, _context):
        if not running():
            self.report({"WARNING"}, "Nothing is being lit")
            return {"CANCELLED"}
        running().cancel()
        return {"FINISHED"}


def _redraw(context):
    """The sidebars, where the panel is; the views themselves may be slow to draw."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


CLASSES = (VMAP_OT_light, VMAP_OT_cancel)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    while _runs:
        _runs.pop().close()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
