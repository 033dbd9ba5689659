# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the vertices of a PLY file: ours with their light, and any other with its colours.

ASCII and both byte orders. In ours (they have irradiance_* or albedo_*) red, green and blue are for display only; in
others they are the albedo, in sRGB.
"""

import os
from dataclasses import dataclass, field

import numpy as np

from .cloud import Cloud
from .color import linear_from_srgb, linear_from_srgb_bytes
from .errors import FileProblem, printable

MAX_HEADER = 1 << 20
SCALARS = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
COLOR_NAMES = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))


@dataclass
class Property:
    name: str
    type: str  # numpy code without byte order
    count_type: str = None  # of a list's length; None for a scalar


@dataclass
class Element:
    name: str
    count: int
    properties: list = field(default_factory=list)

    def has_lists(self):
        return any(p.count_type for p in self.properties)


@dataclass
class Header:
    order: str  # "<", ">" or "" for ASCII
    elements: list
    comments: list
    size: int  # bytes up to the data


def read_ply(path):
    """The Cloud of the file's vertices, in the axes of the file. Throws AddonError with one line."""
    try:
        with open(path, "rb") as file:
            header = parse_header(path, file.read(MAX_HEADER))
            columns, types = _read_vertices(path, file, header)
    except OSError as error:
        raise FileProblem(path, f"cannot read: {error.strerror or error}", "a PLY file") from None
    return _cloud_from(path, columns, types, header.comments)


# --- header ---------------------------------------------------------------------------------------------------------


def parse_header(path, data):
    """Header of the file that begins with these bytes."""

    def fail(found, expected="a PLY file"):
        raise FileProblem(path, found, expected)

    if not data:
        fail("is empty")
    if not data.startswith((b"ply\n", b"ply\r")):
        fail(f"begins with {printable(data[:8].decode('latin-1'))!r}", 'a PLY file, which begins with "ply"')
    end = data.find(b"end_header")
    line_end = data.find(b"\n", end)
    if end < 0 or line_end < 0:
        fail("its header has no end", f'"end_header" within {MAX_HEADER} bytes')

    order, elements, comments = None, [], []
    for line in data[:end].decode("utf-8", "replace").splitlines()[1:]:
        words = line.split()
        if not words or words[0] == "obj_info":
            continue
        if words[0] == "comment":
            comments.append(line.strip()[len("comment") :].strip())
        elif words[0] == "format":
            orders = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
            order = orders.get(words[1] if len(words) > 1 else "")
            if order is None:
                fail(f"format {printable(line)!r}", "ascii, binary_little_endian or binary_big_endian")
        elif words[0] == "element":
            if len(words) != 3 or not words[2].isdigit():
                fail(f"element line {printable(line)!r}", "a name and a count")
            elements.append(Element(words[1], int(words[2])))
        elif words[0] == "property":
            if not elements:
                fail("a property before any element")
            elements[-1].properties.append(_property(line, words, fail))
        else:
            fail(f"header line {printable(line)!r}", "format, comment, element or property")
    if order is None:
        fail("no format line", "ascii, binary_little_endian or binary_big_endian")
    return Header(order, elements, comments, line_end + 1)


def _property(line, words, fail):
    if len(words) == 3 and words[1] in SCALARS:
        return Property(words[2], SCALARS[words[1]])
    if len(words) == 5 and words[1] == "list" and words[2] in SCALARS and words[3] in SCALARS:
        return Property(words[4], SCALARS[words[3]], SCALARS[words[2]])
    return fail(f"property line {printable(line)!r}", "a known type and a name")


# --- data -----------------------------------------------------------------------------------------------------------


def _read_vertices(path, file, header):
    """Name -> array and name -> type code of the properties of the vertices."""
    names = [e.name for e in header.elements]
    if "vertex" not in names:
        raise FileProblem(path, "has no vertices", 'an element "vertex"')
    index = names.index("vertex")
    vertex = header.elements[index]
    if vertex.has_lists():
        raise FileProblem(path, "its vertices have lists", "vertices with plain numbers")
    twice = len({p.name for p in vertex.properties}) != len(vertex.properties)
    if twice or not vertex.properties:
        raise FileProblem(path, "its vertices have a property twice or none", "properties of different names")

    file.seek(0, os.SEEK_END)
    left = file.tell() - header.size
    file.seek(header.size)
    types = {p.name: p.type for p in vertex.properties}
    before = header.elements[:index]
    if header.order == "":
        return _ascii_vertices(path, file, before, vertex, left), types
    return _binary_vertices(path, file, header.order, before, vertex, left), types


def _truncated(path, count):
    return FileProblem(path, "ends too early", f"{count} vertices")


def _binary_vertices(path, file, order, before, vertex, left):
    for element in before:
        left -= _skip_binary(path, file, order, element, left)
    dtype = np.dtype([(p.name, order + p.type) for p in vertex.properties])
    if vertex.count * dtype.itemsize > left:
        raise _truncated(path, vertex.count)
    rows = np.fromfile(file, dtype, vertex.count)
    if len(rows) != vertex.count:
        raise _truncated(path, vertex.count)
    return {name: rows[name] for name in dtype.names}


def _skip_binary(path, file, order, element, left):
    """Moves past the element; the number of bytes that it takes."""
    if not element.has_lists():
        size = element.count * sum(np.dtype(p.type).itemsize for p in element.properties)
        if size > left:
            raise _truncated(path, element.count)
        file.seek(size, os.SEEK_CUR)
        return size

    begin = file.tell()
    if element.count > left:
        raise _truncated(path, element.count)
    for _ in range(element.count):
        for p in element.properties:
            count = 1
            if p.count_type:
                data = file.read(np.dtype(p.count_type).itemsize)
                if len(data) != np.dtype(p.count_type).itemsize:
                    raise _truncated(path, element.count)
                count = int(np.frombuffer(data, order + p.count_type)[0])
            if count < 0 or count * np.dtype(p.type).itemsize > left:
                raise _truncated(path, element.count)
            file.seek(count * np.dtype(p.type).itemsize, os.SEEK_CUR)
    return file.tell() - begin


def _ascii_vertices(path, file, before, vertex, left):
    if 2 * vertex.count * len(vertex.properties) - 1 > left:
        raise _truncated(path, vertex.count)
    for element in before:
        for _ in range(element.count):
            if not file.readline():
                raise _truncated(path, element.count)
    width = len(vertex.properties)
    wanted = vertex.count * width
    words = file.read().split(None, wanted)[:wanted]
    if len(words) < wanted:
        raise _truncated(path, vertex.count)
    try:
        values = np.array(words, dtype="S").astype(np.float64).reshape(vertex.count, width)
    except ValueError as error:
        raise FileProblem(path, printable(error), "numbers") from None
    return {p.name: values[:, i] for i, p in enumerate(vertex.properties)}


# --- meaning --------------------------------------------------------------------------------------------------------


def _cloud_from(path, columns, types, comments):
    def vector(names):
        if all(n in columns for n in names):
            return np.stack([columns[n] for n in names], axis=1).astype(np.float32)
        return None

    def number(name):
        return columns[name].astype(np.float32) if name in columns else None

    def ids(name):
        # Blender has no unsigned attribute: the 32 bits are kept.
        return columns[name].astype(np.int64).astype(np.uint32).view(np.int32) if name in columns else None

    if not all(n in columns for n in "xyz"):
        raise FileProblem(path, "its vertices have no position", "properties x, y and z")
    words = _comment_words(comments)
    positions = np.stack([columns[n] for n in "xyz"], axis=1)
    positions, shift = _small(positions) if types["x"] == "f8" else (positions, np.zeros(3))
    offset = np.array(_floats(words.get("offset"), 3, (0.0, 0.0, 0.0))) + shift
    cloud = Cloud(positions.astype(np.float32), offset=tuple(offset.tolist()))
    cloud.up = "y" if words.get("up") == "y" else "z"
    cloud.normals = vector(("nx", "ny", "nz"))
    if cloud.normals is not None and not cloud.normals.any():
        cloud.normals = None
    cloud.irradiance = vector(("irradiance_r", "irradiance_g", "irradiance_b"))
    cloud.albedo = vector(("albedo_r", "albedo_g", "albedo_b"))
    cloud.emission = vector(("emission_r", "emission_g", "emission_b"))
    if cloud.irradiance is None and cloud.albedo is None:
        names = next((names for names in COLOR_NAMES if all(n in columns for n in names)), None)
        if names:
            cloud.albedo = np.stack([_decoded(columns[n], types[n]) for n in names], axis=1)
    cloud.radius, cloud.area = number("radius"), number("area")
    cloud.face_id, cloud.material_id = ids("face_id"), ids("material_id")
    exposure = _floats(words.get("exposure"), 1, (1.0,))[0]
    cloud.exposure = exposure if exposure > 0 else 1.0
    cloud.info = {key: words[key] for key in ("light_units", "vmap", "source") if key in words}
    return cloud


def _small(positions):
    """Doubles far from zero as differences to their middle, and that middle; others as they are."""
    finite = positions[np.isfinite(positions).all(axis=1)]
    if not len(finite):
        return positions, np.zeros(3)
    low, high = finite.min(axis=0), finite.max(axis=0)
    largest, extent = np.abs(finite).max(), (high - low).max()
    if largest < 1e4 or largest < 10 * extent:
        return positions, np.zeros(3)
    middle = np.round((low + high) / 2)
    return positions - middle, middle


def _decoded(column, type_code):
    """One sRGB channel of any scalar type as linear floats."""
    if type_code[0] == "f":
        return linear_from_srgb(column)
    if type_code == "u1":
        return linear_from_srgb_bytes(column.astype(np.uint8))
    return linear_from_srgb(column.astype(np.float64) / np.iinfo(np.dtype(type_code)).max)


def _comment_words(comments):
    """First word -> rest of each comment; the first of a name counts."""
    words = {}
    for comment in comments:
        key, _, rest = comment.partition(" ")
        words.setdefault(key, rest.strip())
    return words


def _floats(text, count, default):
    try:
        values = tuple(float(word) for word in (text or "").split()[:count])
    except ValueError:
        return default
    return values if len(values) == count and all(np.isfinite(values)) else default
