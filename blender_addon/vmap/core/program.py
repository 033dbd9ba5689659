# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the vmap program and makes sure that it is the one this add-on knows."""

import os
import re
import shutil
import subprocess
from dataclasses import dataclass

from .errors import AddonError, printable

NAME = "vmap"
VERSION = (0, 1, 0)  # of the add-on; a program with the same first two numbers fits
HELP = "Install the vmap toolkit, or set the path of its program in the add-on's preferences"
CHECK_SECONDS = 10


class ProgramError(AddonError):
    """The program cannot be used; the text says what to do."""


@dataclass
class Program:
    path: str
    version: tuple
    light_options: frozenset  # of `vmap light`, for instance --sky

    def version_text(self):
        return ".".join(map(str, self.version))


def find_program(path=""):
    """Full path of the program: the given one, else the one on PATH. Throws ProgramError."""
    if not path:
        found = shutil.which(NAME)
        if not found:
            raise ProgramError(f'no program "{NAME}" on PATH. {HELP}')
        return found
    path = os.path.abspath(os.path.expanduser(path))
    if os.path.isdir(path):
        raise ProgramError(f"{printable(path)} is a folder, not the program. {HELP}")
    if not os.path.isfile(path):
        raise ProgramError(f"{printable(path)} does not exist. {HELP}")
    if not os.access(path, os.X_OK):
        raise ProgramError(f"{printable(path)} is not executable. Allow it to run (chmod +x), or set another path")
    return path


def check_program(path=""):
    """The Program at this path (or on PATH) after asking for its version and options. Throws ProgramError."""
    path = find_program(path)
    answer = _ask(path, "--version").strip()
    match = re.fullmatch(r"(?:vmap )?(\d+)\.(\d+)\.(\d+)\S*", answer.splitlines()[0] if answer else "")
    if not match:
        raise ProgramError(
            f"{printable(path)} is not the vmap program: it calls itself {printable(answer, 60)!r}. {HELP}"
        )
    version = tuple(int(group) for group in match.groups())
    if version[:2] != VERSION[:2]:
        wanted = f"{VERSION[0]}.{VERSION[1]}"
        raise ProgramError(
            f"{printable(path)} is version {'.'.join(map(str, version))}, this add-on needs {wanted}. "
            f"Install vmap {wanted} or the add-on that belongs to your version"
        )
    return Program(path, version, frozenset(re.findall(r"--[a-z][a-z-]+", _ask(path, "light", "--help"))))


def _ask(path, *arguments):
    try:
        done = subprocess.run(
            [path, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=CHECK_SECONDS,
        )
    except subprocess.TimeoutExpired:
        raise ProgramError(f"{printable(path)} did not answer within {CHECK_SECONDS} s. {HELP}") from None
    except OSError as error:
        raise ProgramError(f"{printable(path)} cannot be run: {error.strerror or error}. {HELP}") from None
    text = done.stdout[:65536].decode("utf-8", "replace")
    if done.returncode:
        last = text.strip().splitlines()[-1:] or ["nothing"]
        raise ProgramError(
            f"{printable(path)} {' '.join(arguments)} failed and said {printable(last[0], 100)!r}. {HELP}"
        )
    return text
