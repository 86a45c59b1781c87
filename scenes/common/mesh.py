"""Meshes from formulae: grids bent by a function, solids of revolution, balls; written as binary PLY."""
import array
import math
import os
import sys


def add(a, b, s=1.0):
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    length = math.sqrt(dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length) if length > 0 else (0.0, 0.0, 1.0)


def rotate_y(p, angle):
    c, s = math.cos(angle), math.sin(angle)
    return (c * p[0] + s * p[2], p[1], c * p[2] - s * p[0])


class Mesh:
    """Triangles with a normal and a (u, v) for each vertex."""

    def __init__(self):
        self.vertices = []  # (position, normal, uv)
        self.faces = []     # three indices, counterclockwise seen from where the normals point

    def append(self, other, move=lambda p: p, turn=lambda n: n):
        """Adds a copy of another mesh; `move` places its points, `turn` its normals."""
        first = len(self.vertices)
        self.vertices += [(move(p), turn(n), uv) for p, n, uv in other.vertices]
        self.faces += [(a + first, b + first, c + first) for a, b, c in other.faces]

    def write_ply(self, path):
        data = array.array("f")
        for p, n, uv in self.vertices:
            data.extend((*p, *n, *uv))
        faces = bytearray()
        for face in self.faces:
            faces += b"\x03" + array.array("i", face).tobytes()
        names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
        header = (f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {len(self.vertices)}\n"
                  + "".join(f"property float {name}\n" for name in names)
                  + f"element face {len(self.faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        write_file(path, header.encode() + data.tobytes() + bytes(faces))


def write_file(path, content):
    """Into a file beside it that is then renamed: never a part of one."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    partial = f"{path}.{os.getpid()}.part"
    with open(partial, "wb") as file:
        file.write(content)
    os.replace(partial, path)


def surface(point, columns, rows, h=1e-4):
    """The surface point(u, v), (u, v) in [0, 1]^2; normals along d/du x d/dv by differences. Where triangles shrink to
    nothing, as at poles, they are left out."""
    mesh = Mesh()
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            across = add(point(u + h, v), point(u - h, v), -1)
            along = add(point(u, v + h), point(u, v - h), -1)
            if max(dot(across, across), dot(along, along)) < 1e-20:
                raise ValueError(f"the surface has no tangent at {u}, {v}")
            if dot(across, across) < 1e-10 * dot(along, along):  # a pole: from a little beside it
                beside = v + (20 * h if v < 0.5 else -20 * h)
                across = add(point(u + h, beside), point(u - h, beside), -1)
            mesh.vertices.append((point(u, v), normalize(cross(across, along)), (u, v)))
    for j in range(rows):
        for i in range(columns):
            a, b = j * (columns + 1) + i, j * (columns + 1) + i + 1
            c, d = a + columns + 1, b + columns + 1
            for face in ((a, b, d), (a, d, c)):
                p, q, r = (mesh.vertices[k][0] for k in face)
                area = cross(add(q, p, -1), add(r, p, -1))
                if dot(area, area) > 1e-18:
                    mesh.faces.append(face)
    return mesh


def smooth_curve(points, per_span):
    """Points of a centripetal Catmull-Rom curve through `points` (2D), `per_span` to each span. A point that is given
    twice in a row is a corner."""
    pieces, piece = [], [points[0]]
    for p in points[1:]:
        if p == piece[-1]:
            pieces.append(piece)
            piece = [p]
        else:
            piece.append(p)
    pieces.append(piece)
    return [smooth_piece(piece, per_span) for piece in pieces]


def smooth_piece(points, per_span):
    if len(points) == 2:
        return list(points)
    mirror = lambda a, b: (2 * a[0] - b[0], 2 * a[1] - b[1])
    p = [mirror(points[0], points[1]), *points, mirror(points[-1], points[-2])]
    curve = []
    for k in range(1, len(p) - 2):
        knots = [0.0]
        for a, b in zip(p[k - 1:k + 2], p[k:k + 3]):
            knots.append(knots[-1] + math.sqrt(math.dist(a, b)))
        for step in range(per_span):
            t = knots[1] + (knots[2] - knots[1]) * step / per_span
            level, width = p[k - 1:k + 3], 1
            while len(level) > 1:  # Barry and Goldman 1988: a pyramid of linear interpolations
                level = [lerp(level[i], level[i + 1], t, *span(knots, i, width, len(level))) for i in range(len(level) - 1)]
                width += 1
            curve.append(level[0])
    return curve + [points[-1]]


def span(knots, i, width, count):
    """Knots between which level `width` of the pyramid interpolates: the last level uses the middle ones only."""
    return (knots[i], knots[i + 1]) if width == 1 else (knots[i], knots[i + 2]) if width == 2 else (knots[1], knots[2])


def lerp(a, b, t, t0, t1):
    w = (t - t0) / (t1 - t0)
    return tuple((1 - w) * x + w * y for x, y in zip(a, b))


def lathe(profile, sides=96, per_span=8, inward=False):
    """Turns a profile [(radius, height)...] around y. The normals point outwards where the profile rises; `inward`
    turns them. u runs around, v along the profile; corners as in smooth_curve."""
    mesh, total = Mesh(), 0.0
    pieces = smooth_curve(profile, per_span)
    whole = sum(math.dist(a, b) for piece in pieces for a, b in zip(piece, piece[1:]))
    for piece in pieces:
        first = len(mesh.vertices)
        for k, (r, y) in enumerate(piece):
            before, after = piece[max(k - 1, 0)], piece[min(k + 1, len(piece) - 1)]
            tangent = normalize((after[0] - before[0], after[1] - before[1], 0))
            if r == 0:  # on the axis the profile is level
                tangent = (1.0 if after[0] > before[0] else -1.0, 0.0, 0.0)
            total += math.dist(before, piece[k]) if k else 0
            sign = -1.0 if inward else 1.0
            for i in range(sides + 1):
                a = 2 * math.pi * i / sides
                out = (math.cos(a), 0.0, -math.sin(a))
                normal = (sign * tangent[1] * out[0], sign * -tangent[0], sign * tangent[1] * out[2])
                mesh.vertices.append(((r * out[0], y, r * out[2]), normal, (i / sides, total / whole)))
        for k in range(len(piece) - 1):
            for i in range(sides):
                a = first + k * (sides + 1) + i
                b, c, d = a + 1, a + sides + 1, a + sides + 2
                faces = [(a, b, d)] if piece[k][0] > 0 else []
                if piece[k + 1][0] > 0:
                    faces.append((a, d, c))
                mesh.faces += [(x, z, y) if inward else (x, y, z) for x, y, z in faces]
    return mesh
