# SPDX-License-Identifier: GPL-3.0-or-later
"""One run of the program as a child process that never blocks: start, poll, cancel.

Blender's timers do not fire headless, so the same Job serves a loop that blocks and a modal operator that polls.
"""

import collections
import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time

from .errors import AddonError, printable

KEPT_LINES = 20
LONGEST_LINE = 2000  # bytes; what comes after it until the next line break is dropped
GRACE_SECONDS = 0.5  # between asking the program to end and ending it
READ_SIZE = 1 << 16


class JobError(AddonError):
    """The program failed; lines holds the last ones it wrote, oldest first."""

    def __init__(self, text, lines=()):
        super().__init__(text)
        self.lines = list(lines)


class Job:
    """A child process in a temporary folder of its own.

    arguments: called with the folder, returns the command line; the program is told to write its progress to
    progress_path(folder). The folder goes away with close(), whatever happened; use the Job as a context manager.
    """

    def __init__(self, arguments, time_limit=0.0):
        self.folder = tempfile.mkdtemp(prefix="vmap-")
        self.cancelled = False
        self._time_limit = time_limit
        self._progress = _ProgressFile(progress_path(self.folder))
        self._lines = _LastLines()
        self._kill_at = None
        self._process = None
        self._command = [str(a) for a in arguments(self.folder)]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def start(self):
        try:
            self._process = subprocess.Popen(
                self._command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                cwd=self.folder,
                start_new_session=os.name == "posix",  # so that its own children end with it
            )
        except (OSError, ValueError) as error:
            raise JobError(f"{printable(self._command[0])}: cannot start: {error}") from None
        self._started = time.monotonic()
        self._reader = threading.Thread(target=self._read, args=(self._process.stderr,), daemon=True)
        self._reader.start()
        return self

    def poll(self):
        """True when the program has ended. Takes no time worth mentioning; call it often."""
        self._progress.read()
        now = time.monotonic()
        if self._time_limit and now - self._started > self._time_limit and not self.cancelled:
            self._lines.add(f"stopped after {self._time_limit:g} s, the time limit".encode() + b"\n")
            self.cancel(timed_out=True)
        if self._kill_at and now >= self._kill_at:
            self._signal(kill=True)
        if self._process.poll() is None:
            return False
        self._reader.join(timeout=0.2)  # a grandchild may hold the pipe open
        self._progress.read()
        return True

    def cancel(self, timed_out=False):
        """Asks the program to end and returns at once; poll() ends it the hard way when it does not."""
        if self._process is None or self._process.poll() is not None or self.cancelled:
            return
        self.cancelled = not timed_out
        self._time_limit = 0
        self._kill_at = time.monotonic() + GRACE_SECONDS
        self._signal(kill=False)

    def wait(self, step=0.02, each=None):
        """Blocks until the end; calls each(self) between looks. An exception, Ctrl-C for one, ends the program."""
        try:
            while not self.poll():
                if each:
                    each(self)
                time.sleep(step)
        except BaseException:
            self.cancel()
            while not self.poll():
                time.sleep(step)
            raise

    def check(self):
        """Throws JobError when the program has ended with anything but success."""
        code = self._process.returncode
        if code == 0:
            return
        lines = self.last_lines()
        if self.cancelled:
            raise JobError("cancelled", lines)
        how = f"was ended by {_signal_name(-code)}" if code < 0 else f"ended with code {code}"
        said = next((line for line in reversed(lines) if line.startswith("vmap: error:")), lines[-1] if lines else "")
        text = f"the program {how}" + (f": {said}" if said else " and said nothing")
        raise JobError(text, lines)

    @property
    def progress(self):
        return self._progress.latest

    @property
    def seconds_left(self):
        """Rough time to the end, or None while it is too early to say."""
        share = self.progress.overall
        if share < 0.05:
            return None
        return (time.monotonic() - self._started) * (1 - share) / share

    def last_lines(self):
        return self._lines.all()

    def warnings(self):
        """What the program warned about, as far as it is among its last lines."""
        prefix = "vmap: warning: "
        return [line[len(prefix) :] for line in self.last_lines() if line.startswith(prefix)]

    def close(self):
        """Ends the program if need be and removes the folder."""
        process = self._process
        if process is not None and process.poll() is None:
            self._signal(kill=True)
            process.wait()
        if process is not None:
            self._reader.join(timeout=0.5)
            if not self._reader.is_alive():
                process.stderr.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _read(self, stream):
        try:
            while data := os.read(stream.fileno(), READ_SIZE):
                self._lines.add(data)
        except (OSError, ValueError):
            pass

    def _signal(self, kill):
        try:
            if os.name == "posix":
                os.killpg(self._process.pid, signal.SIGKILL if kill else signal.SIGTERM)
            elif kill:
                self._process.kill()
            else:
                self._process.terminate()
        except (ProcessLookupError, PermissionError):
            pass


def progress_path(folder):
    return os.path.join(folder, "progress.jsonl")


class Progress:
    """Where the program stands: stage by name, its fraction and that of the whole in [0, 1]."""

    def __init__(self, stage="", fraction=0.0, overall=0.0):
        self.stage = stage
        self.fraction = fraction
        self.overall = overall


class _ProgressFile:
    """The last valid line of a file that grows; anything else in it is passed over."""

    def __init__(self, path):
        self.latest = Progress()
        self._path = path
        self._position = 0
        self._rest = b""

    def read(self):
        try:
            with open(self._path, "rb") as file:
                file.seek(self._position)
                data = file.read(1 << 20)
        except OSError:
            return
        self._position += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        self._rest = self._rest[-LONGEST_LINE:]
        for line in lines:
            self._take(line)

    def _take(self, line):
        try:
            entry = json.loads(line)
            stage, fraction = str(entry["stage"]), float(entry["fraction"])
            overall = float(entry.get("overall", fraction))
        except (ValueError, TypeError, KeyError, RecursionError):
            return
        if 0 <= fraction <= 1 and 0 <= overall <= 1:
            self.latest = Progress(printable(stage, 40), fraction, overall)


class _LastLines:
    """What the program wrote last; filled by one thread and read by another."""

    def __init__(self):
        self._lock = threading.Lock()
        self._lines = collections.deque(maxlen=KEPT_LINES)
        self._rest = b""

    def add(self, data):
        with self._lock:
            *lines, self._rest = (self._rest + data).replace(b"\r", b"\n").split(b"\n")
            self._rest = self._rest[:LONGEST_LINE]
            self._lines.extend(_clean(line) for line in lines[-2 * KEPT_LINES :] if line.strip())

    def all(self):
        with self._lock:
            lines = list(self._lines)
            return lines + [_clean(self._rest)] if self._rest.strip() else lines


def _clean(line):
    return printable(line[:LONGEST_LINE].decode("utf-8", "replace").strip(), LONGEST_LINE)


def _signal_name(number):
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
