# SPDX-License-Identifier: GPL-3.0-or-later
"""Files numbered by frame: lit_0001.ply, lit_0002.ply, ..."""

import os
import re
from dataclasses import dataclass


@dataclass
class Sequence:
    """Files of one name with their frame numbers; a single file has the frame None."""

    paths: list
    frames: list

    @property
    def animated(self):
        return len(self.paths) > 1

    def path_at(self, frame):
        """The file of the last frame that is not after this one; before the first, the first."""
        best = self.paths[0]
        for path, number in zip(self.paths, self.frames):
            if number is not None and number <= frame:
                best = path
        return best


def group_sequences(paths, detect=True):
    """The files as sequences: those that differ in their last number only belong together, in order of frames."""
    groups, result = {}, []
    for path in paths:
        folder, name = os.path.split(path)
        match = re.fullmatch(r"(.*?)(\d+)(\.[^.]+)", name)
        if not (detect and match):
            result.append(Sequence([path], [None]))
            continue
        key = (folder, match[1], match[3].lower())
        if key not in groups:
            groups[key] = []
            result.append(key)
        groups[key].append((int(match[2]), path))
    return [_sequence_of(groups[entry]) if isinstance(entry, tuple) else entry for entry in result]


def _sequence_of(numbered):
    numbered = sorted(dict(numbered).items())
    if len(numbered) == 1:
        return Sequence([numbered[0][1]], [None])
    return Sequence([path for _, path in numbered], [frame for frame, _ in numbered])


def frame_path(folder, stem, frame, extension):
    return os.path.join(folder, f"{stem}_{frame:04d}{extension}")
