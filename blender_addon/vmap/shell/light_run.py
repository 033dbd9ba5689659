# SPDX-License-Identifier: GPL-3.0-or-later
"""Light this scene, step by step: read it, let the program light it, bring the light back.

One object serves the operator that blocks and the one that runs beside the user: step() does a little and returns.
Until the very end nothing is added to the file; whatever happens, close() leaves no process and no temporary file.
"""

import os
import shutil
import tempfile

import bpy

from ..core.errors import AddonError, printable
from ..core.glb_writer import write_glb
from ..core.job import Job, progress_path
from ..core.light_command import LightRequest, light_command, read_report
from ..core.program import check_program
from ..core.read_cloud import read_cloud
from ..core.sequence import Sequence, frame_path
from . import sequence_player
from .bring_back import light_on_meshes
from .datablocks import all_or_nothing, link_and_select, remove_object
from .point_object import point_object
from .preferences import program_path
from .scene_reader import RESULT_MARK, read_scene
from .volume_object import volume_object

EXTENSIONS = {"CLOUD": ".ply", "ATTRIBUTE": ".ply", "VOLUME": ".vdb"}


class LightRun:
    """settings: anything with the properties of scene_settings.LightSettings."""

    def __init__(self, context, settings):
        self.context = context
        self.settings = settings
        self.results = set(settings.result)
        self.notes = []  # (kind of report, line)
        self.job = None
        self.cancelled = False
        self.made = []
        self.done_frames = 0
        self.frames = self._frames()
        self._check()
        self.program = check_program(program_path())
        self.stem = bpy.path.clean_name(context.scene.name) + "_lit"
        self.folder = tempfile.mkdtemp(prefix="vmap-")
        self._steps = self._work()

    def _frames(self):
        if not self.settings.use_frames:
            return [self.context.scene.frame_current]
        return list(range(self.settings.frame_start, self.settings.frame_end + 1))

    def _check(self):
        if not self.results:
            raise AddonError("no result is chosen; expected lit points, a mesh attribute or a lit volume")
        if self.context.mode != "OBJECT":
            raise AddonError("expected Object Mode")
        if not self.frames:
            raise AddonError("the last frame is before the first")
        if self.settings.use_frames and "ATTRIBUTE" in self.results:
            raise AddonError(
                "a mesh attribute holds the light of one frame; choose lit points or a volume for animation"
            )
        if self.settings.points and self.settings.spacing:
            raise AddonError("points and spacing exclude each other; set one of them to 0")
        self.directory = self._directory() if self.settings.use_frames or "VOLUME" in self.results else ""

    def _directory(self):
        chosen = self.settings.directory
        if not chosen and not bpy.data.filepath:
            raise AddonError("volumes and frames are kept as files: save the .blend file first, or choose a folder")
        folder = bpy.path.abspath(chosen or "//vmap_light")
        above = folder
        while not os.path.exists(above):
            above = os.path.dirname(above)
        if not os.path.isdir(above) or not os.access(above, os.W_OK):
            raise AddonError(f"{folder}: cannot write there; choose another folder")
        return folder

    # --- what the outside calls ---

    def step(self):
        """Does a little; True when all is done. Throws AddonError, after which only close() may be called."""
        try:
            next(self._steps)
        except StopIteration:
            return True
        except OSError as error:
            raise AddonError(f"{printable(error.filename or 'a file')}: {error.strerror or error}") from None
        return False

    def cancel(self):
        self.cancelled = True
        if self.job:
            self.job.cancel()

    def close(self):
        self._steps.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def overall(self):
        """How much is done, in [0, 1]."""
        share = self.job.progress.overall if self.job else 0.0
        return min((self.done_frames + share) / len(self.frames), 1.0)

    def status(self):
        """One line for the panel."""
        frame = f"frame {self.done_frames + 1} of {len(self.frames)}, " if len(self.frames) > 1 else ""
        if self.job is None:
            return frame + "reading the scene"
        left = self.job.seconds_left
        return frame + (self.job.progress.stage or "starting") + (f", {left:.0f} s left" if left is not None else "")

    # --- the work ---

    def _work(self):
        for frame in self.frames:
            yield
            if self.cancelled:
                raise AddonError("cancelled")
            yield from self._light_frame(frame)
            self.done_frames += 1
        with all_or_nothing():
            self._bring_back()
        self._remove_earlier_results()
        link_and_select(self.context, self.made)

    def _light_frame(self, frame):
        with_sky = "--sky" in self.program.light_options
        scene = read_scene(self.context, frame, self.folder, self.settings.selected_only, with_sky)
        self._note_what_is_lost(scene)
        self.face_ranges = scene.face_ranges()
        extensions = sorted({EXTENSIONS[result] for result in self.results})
        request = LightRequest(self.settings.tolerance, self.settings.points, self.settings.spacing, scene.sky)

        def command(folder):
            path = os.path.join(folder, "scene.glb")
            write_glb(path, scene)
            outputs = [os.path.join(folder, "lit" + extension) for extension in extensions]
            report = os.path.join(folder, "report.json")
            return light_command(self.program, path, outputs, report, progress_path(folder), request)

        with Job(command, self.settings.time_limit) as job:
            self.job = job
            try:
                job.start()
                while not job.poll():
                    yield
                if self.cancelled:
                    raise AddonError("cancelled")
                job.check()
                self._note_report(read_report(os.path.join(job.folder, "report.json")))
                for extension in extensions:
                    written = os.path.join(job.folder, "lit" + extension)
                    if not os.path.isfile(written):
                        raise AddonError(f"the program ended well but wrote no {extension} file")
                    shutil.move(written, frame_path(self.folder, self.stem, frame, extension))
            finally:
                self.job = None

    def _warn(self, line):
        """Once, however many frames say it."""
        if ("WARNING", line) not in self.notes:
            self.notes.append(("WARNING", line))

    def _note_what_is_lost(self, scene):
        for line in scene.not_carried():
            self._warn(f"Not carried: {line}")

    def _note_report(self, report):
        error = f", estimated error {100 * report.error_mean:.2g} %" if report.error_mean is not None else ""
        self.notes.append(("INFO", f"{report.points} points lit in {report.seconds:.2f} s{error}"))
        for warning in report.warnings:
            self._warn(warning)

    def _bring_back(self):
        if self.directory:
            os.makedirs(self.directory, exist_ok=True)
        paths = {ext: self._kept_paths(ext) for ext in {EXTENSIONS[result] for result in self.results}}
        if ".ply" in paths:
            self._bring_back_points(paths[".ply"])
        if ".vdb" in paths:
            sequence = self._sequence([self._keep(path) for path in paths[".vdb"]])
            self._add(volume_object(self.context, sequence, self.stem + " volume"), "VOLUME")

    def _bring_back_points(self, paths):
        cloud = read_cloud(paths[0])
        if "CLOUD" in self.results:
            animated = len(paths) > 1
            item = point_object(self.context, cloud, self.stem, as_mesh=animated)
            if animated:
                sequence_player.attach(item, self._sequence([self._keep(path) for path in paths]))
                sequence_player.update(item, self.context.scene.frame_current)
            self._add(item, "CLOUD")
        if "ATTRIBUTE" in self.results:
            written = light_on_meshes(self.context, cloud, self.face_ranges, self.settings.domain, self._warn)
            if not written:
                raise AddonError("no mesh could keep the light: " + self.notes[-1][1])
            self.notes.append(("INFO", f'attribute "irradiance" on {len(written)} meshes'))

    def _add(self, item, kind):
        item[RESULT_MARK] = kind
        self.made.append(item)

    def _kept_paths(self, extension):
        return [frame_path(self.folder, self.stem, frame, extension) for frame in self.frames]

    def _keep(self, path):
        """Moves a file to the folder that stays; a single frame loses its number."""
        name = os.path.basename(path)
        if not self.settings.use_frames:
            name = self.stem + os.path.splitext(name)[1]
        return shutil.move(path, os.path.join(self.directory, name))

    def _sequence(self, paths):
        return Sequence(paths, self.frames if len(paths) > 1 else [None])

    def _remove_earlier_results(self):
        kinds = {item[RESULT_MARK] for item in self.made}
        for item in list(self.context.scene.objects):
            if item.get(RESULT_MARK) in kinds and item not in self.made:
                remove_object(item)
