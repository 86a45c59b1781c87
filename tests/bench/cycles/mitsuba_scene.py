"""Reads as much of a Mitsuba 3 scene as the comparison needs: transforms, one sensor, rectangles, cubes and binary PLY
meshes, diffuse, dielectric and roughconductor, area and envmap emitters. Anything else ends with an error: a scene that
was only half understood would be compared with another one."""
import array
import math
import os
import sys
import xml.etree.ElementTree as ElementTree


def fail(message):
    sys.exit(f"{message} is not supported by this adapter")


def numbers(text, count=3):
    values = [float(v) for v in text.replace(",", " ").split()]
    return values * count if len(values) == 1 else values


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalize(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


IDENTITY = [[float(i == j) for j in range(4)] for i in range(4)]


def one_transform(element):
    axes = [float(element.get(axis, "0")) for axis in "xyz"]
    if element.tag == "translate":
        offset = numbers(element.get("value")) if element.get("value") else axes
        return [[*IDENTITY[i][:3], offset[i]] for i in range(3)] + [IDENTITY[3]]
    if element.tag == "scale":
        value = element.get("value")
        factors = numbers(value) if value else [float(element.get(axis, "1")) for axis in "xyz"]
        return [[factors[i] * IDENTITY[i][j] if i < 3 else IDENTITY[i][j] for j in range(4)] for i in range(4)]
    if element.tag == "rotate":  # Rodrigues
        u = normalize(numbers(element.get("value")) if element.get("value") else axes)
        angle = math.radians(float(element.get("angle")))
        c, s = math.cos(angle), math.sin(angle)
        k = [[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]]
        return [[c * (i == j) + (1 - c) * u[i] * u[j] + s * k[i][j] for j in range(3)] + [0.0] for i in range(3)] + [IDENTITY[3]]
    if element.tag == "lookat":
        origin, target, up = (numbers(element.get(name)) for name in ("origin", "target", "up"))
        forward = normalize([t - o for t, o in zip(target, origin)])
        left = normalize(cross(up, forward))
        up = cross(forward, left)
        return [[left[i], up[i], forward[i], origin[i]] for i in range(3)] + [IDENTITY[3]]
    if element.tag == "matrix":
        m = numbers(element.get("value"))
        return [m[4 * i:4 * i + 4] for i in range(4)]
    fail(f"transform <{element.tag}>")


def to_world(element):
    matrix = IDENTITY
    for child in element.findall("transform"):
        for step in child:
            matrix = multiply(one_transform(step), matrix)
    return matrix


def value(element, name, default=None):
    for child in element:
        if child.get("name") == name and child.tag in ("float", "integer", "string", "rgb", "boolean"):
            return child.get("value")
    return default


def read_ply(path):
    """(vertices as a flat array of positions, triangles as a flat array of indices)"""
    with open(path, "rb") as file:
        if file.readline().strip() != b"ply":
            fail(f"{path}: what is no PLY")
        vertex_count = face_count = 0
        properties, element = [], ""
        while True:
            words = file.readline().decode().split()
            if words[0] == "format" and words[1] != f"binary_{sys.byteorder}_endian":
                fail(f"PLY of format {words[1]}")
            if words[0] == "element":
                element = words[1]
                if element == "vertex":
                    vertex_count = int(words[2])
                else:
                    face_count = int(words[2])
            if words[0] == "property" and element == "vertex":
                if words[1] not in ("float", "float32"):
                    fail("PLY with vertex properties that are not floats")
                properties.append(words[2])
            if words[0] == "property" and element == "face" and words[1:4] not in (["list", "uchar", "int"],
                                                                                 ["list", "uint8", "int32"]):
                fail("PLY with such faces")
            if words[0] == "end_header":
                break
        rows = array.array("f")
        rows.fromfile(file, vertex_count * len(properties))
        faces = file.read(13 * face_count)
    if len(faces) != 13 * face_count or faces[::13] != b"\x03" * face_count:
        fail("PLY with faces other than triangles")
    positions = array.array("f", bytes(12 * vertex_count))
    for axis in range(3):
        positions[axis::3] = rows[properties.index("xyz"[axis])::len(properties)]
    indices = array.array("i")
    indices.frombytes(b"".join(faces[i + 1:i + 13] for i in range(0, len(faces), 13)))
    return positions, indices


def rectangle():
    return array.array("f", [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), array.array("i", [0, 1, 2, 0, 2, 3])


def cube():
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [i for a, b, c, d in quads for i in (a, b, c, a, c, d)]
    return array.array("f", [x for p in corners for x in p]), array.array("i", triangles)


class Scene:
    """The root element with every $name replaced, and the folder that file names are relative to."""

    def __init__(self, path, defines):
        self.folder = os.path.dirname(os.path.abspath(path))
        self.root = ElementTree.parse(path).getroot()
        names = {d.get("name"): d.get("value") for d in self.root.findall("default")}
        names.update(defines)
        for element in self.root.iter():
            for key, text in element.attrib.items():
                for name in sorted(names, key=len, reverse=True):
                    text = text.replace("$" + name, names[name])
                element.set(key, text)
        self.bsdfs = {b.get("id"): b for b in self.root.findall("bsdf")}

    def file(self, element):
        return os.path.join(self.folder, value(element, "filename"))

    def bsdf_of(self, shape):
        for reference in shape.findall("ref"):
            if reference.get("id") in self.bsdfs:
                return self.bsdfs[reference.get("id")]
        return shape.find("bsdf")

    def mesh_of(self, shape):
        kind = shape.get("type")
        if kind == "rectangle":
            return rectangle()
        if kind == "cube":
            return cube()
        if kind == "ply":
            return read_ply(self.file(shape))
        fail(f"shape {kind}")
