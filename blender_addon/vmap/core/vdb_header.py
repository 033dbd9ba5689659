# SPDX-License-Identifier: GPL-3.0-or-later
"""What an OpenVDB file says about its grids, without OpenVDB: names, types and metadata, not the voxels.

Reads files of version 222 and later (OpenVDB 2.1, 2013), as far as the layout of
https://www.openvdb.org/documentation/doxygen/ describes headers, grid descriptors and metadata maps.
"""

import struct
from dataclasses import dataclass, field

from .errors import FileProblem, printable

MAGIC = 0x56444220
OLDEST = 222
MAX_STRING = 1 << 20
MAX_GRIDS = 1 << 16
HAS_GRID_OFFSETS_BYTES = 1
UUID_BYTES = 36
EXPECTED = "an OpenVDB file"
FORMATS = {"float": "<f", "double": "<d", "int32": "<i", "int64": "<q", "bool": "<?", "vec3s": "<3f", "vec3d": "<3d",
           "vec3i": "<3i"}  # fmt: skip


@dataclass
class VdbGrid:
    name: str
    type: str  # for instance Tree_vec3s_5_4_3
    metadata: dict = field(default_factory=dict)

    @property
    def holds_points(self):
        return "ptdataidx" in self.type


@dataclass
class VdbFile:
    grids: list
    metadata: dict

    def grid(self, name):
        return next((g for g in self.grids if g.name == name and not g.holds_points), None)


def read_vdb_header(path):
    """VdbFile. Throws AddonError with one line."""
    try:
        with open(path, "rb") as file:
            return _Reader(path, file).read()
    except OSError as error:
        raise FileProblem(path, f"cannot read: {error.strerror or error}", EXPECTED) from None


class _Reader:
    def __init__(self, path, file):
        self.path = path
        self.file = file

    def fail(self, found):
        raise FileProblem(self.path, found, EXPECTED)

    def take(self, size):
        data = self.file.read(size)
        if len(data) != size:
            self.fail("ends too early")
        return data

    def number(self, code):
        return struct.unpack("<" + code, self.take(struct.calcsize("<" + code)))[0]

    def string(self):
        size = self.number("I")
        if size > MAX_STRING:
            self.fail(f"a name of {size} bytes")
        return self.take(size).decode("utf-8", "replace")

    def read(self):
        start = self.file.read(8)
        if not start:
            self.fail("is empty")
        if start != struct.pack("<q", MAGIC):
            self.fail(f"begins with {printable(start.decode('latin-1'))!r}")
        version = self.number("I")
        if version < OLDEST:
            self.fail(f"file version {version}")
        self.take(8)  # version of the library
        if not self.number("?"):
            self.fail("a stream without grid offsets")
        self.take(UUID_BYTES)
        metadata = self.metadata()
        count = self.number("i")
        if not 0 <= count <= MAX_GRIDS:
            self.fail(f"{count} grids")
        return VdbFile([self.grid() for _ in range(count)], metadata)

    def grid(self):
        name = self.string().split("\x1e")[0]  # the library numbers grids of one name behind this sign
        kind = self.string()
        self.string()  # parent of an instance
        begin, _, end = struct.unpack("<3q", self.take(24))
        here = self.file.tell()
        if not here <= begin <= end:
            self.fail("grid offsets that do not fit")
        self.file.seek(begin)
        self.number("I")  # compression
        metadata = self.metadata()
        self.file.seek(0, 2)
        if end > self.file.tell():
            self.fail("ends too early")
        self.file.seek(end)
        return VdbGrid(name, kind, metadata)

    def metadata(self):
        count = self.number("I")
        if count > MAX_GRIDS:
            self.fail(f"{count} entries of metadata")
        return dict(self.entry() for _ in range(count))

    def entry(self):
        name, kind, size = self.string(), self.string(), self.number("I")
        if size > MAX_STRING:
            self.fail(f"metadata of {size} bytes")
        data = self.take(size)
        if kind == "string":
            return name, data.decode("utf-8", "replace")
        if kind in FORMATS and struct.calcsize(FORMATS[kind]) == size:
            values = struct.unpack(FORMATS[kind], data)
            return name, values[0] if len(values) == 1 else values
        return name, None
