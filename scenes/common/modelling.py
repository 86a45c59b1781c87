"""What the generators of scenes share: meshes (surfaces of revolution, bicubic patches, tubes) as binary PLY.

Vectors are tuples (x, y, z), y is up. A surface is a function of (u, v) in [0, 1]^2; the side to which the cross
product of its derivatives dp/du x dp/dv points is its outside: there triangles are counterclockwise.
"""
import array
import math
import os
import sys


def add(a, b, s=1.0):
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def scaled(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    length = math.sqrt(dot(a, a))
    return scaled(a, 1 / length) if length > 0 else (0.0, 1.0, 0.0)


def rotation(axis, degrees):
    """The map that turns a vector about an axis ('x', 'y' or 'z'), right-handed."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3

    def turn(p):
        q = list(p)
        q[j], q[k] = c * p[j] - s * p[k], s * p[j] + c * p[k]
        return tuple(q)
    return turn


def placed(*maps):
    """One map out of several, the first acts first; a tuple stands for a translation."""
    def place(p):
        for step in maps:
            p = step(p) if callable(step) else add(p, step)
        return p
    return place


def smooth(points, steps):
    """Samples of the Catmull-Rom spline through points (of any dimension), steps between two of them."""
    ends = [tuple(2 * a - b for a, b in zip(points[0], points[1]))]
    ends += list(points) + [tuple(2 * a - b for a, b in zip(points[-1], points[-2]))]
    samples = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for k in range(steps):
            t = k / steps
            w = (-0.5 * t + t * t - 0.5 * t ** 3, 1 - 2.5 * t * t + 1.5 * t ** 3,
                 0.5 * t + 2 * t * t - 1.5 * t ** 3, -0.5 * t * t + 0.5 * t ** 3)
            samples.append(tuple(w[0] * p + w[1] * q + w[2] * r + w[3] * s for p, q, r, s in zip(a, b, c, d)))
    return samples + [tuple(points[-1])]


def bezier(weights, t):
    """Point of a cubic Bezier curve of four control points."""
    s = 1 - t
    b = (s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t)
    return tuple(sum(b[i] * weights[i][k] for i in range(4)) for k in range(len(weights[0])))


class Mesh:
    def __init__(self):
        self.vertices, self.faces, self.count = array.array("f"), bytearray(), 0

    def vertex(self, p, n, uv=(0.0, 0.0)):
        self.vertices.extend((*p, *n, *uv))
        self.count += 1
        return self.count - 1

    def triangle(self, a, b, c):
        self.faces += b"\x03" + array.array("i", (a, b, c)).tobytes()

    def surface(self, point, columns, rows, place=None, uv=lambda u, v: (u, v)):
        """The surface point(u, v) as columns x rows squares; normals by finite differences."""
        h = 1e-4
        here = placed(place) if place else lambda p: p
        corner = []
        for j in range(rows + 1):
            for i in range(columns + 1):
                u, v = i / columns, j / rows
                u0, u1, v0, v1 = max(u - h, 0), min(u + h, 1), max(v - h, 0), min(v + h, 1)
                along_u = add(here(point(u1, v)), here(point(u0, v)), -1)
                along_v = add(here(point(u, v1)), here(point(u, v0)), -1)
                corner.append(self.vertex(here(point(u, v)), normalize(cross(along_u, along_v)), uv(u, v)))
        width = columns + 1
        for j in range(rows):
            for i in range(columns):
                a, b = corner[j * width + i], corner[j * width + i + 1]
                c, d = corner[(j + 1) * width + i], corner[(j + 1) * width + i + 1]
                self.triangle(a, b, d)
                self.triangle(a, d, c)

    def patch(self, controls, columns, rows, place=None, uv=lambda u, v: (u, v)):
        """A bicubic Bezier patch: controls[j][i], i along u."""
        def point(u, v):
            return bezier([bezier(row, u) for row in controls], v)
        self.surface(point, columns, rows, place, uv)

    def lathe(self, profile, sides, place=None):
        """Turns the smooth curve profile of (radius, height) about y. Outside is to the right of its direction."""
        here = placed(place) if place else lambda p: p
        lengths = [0.0]
        for a, b in zip(profile, profile[1:]):
            lengths.append(lengths[-1] + math.dist(a, b))
        rings = []
        for k, (r, y) in enumerate(profile):
            before, after = profile[max(k - 1, 0)], profile[min(k + 1, len(profile) - 1)]
            dr, dy = after[0] - before[0], after[1] - before[1]
            if r == 0:
                dy = 0.0
            ring = []
            for i in range(sides + 1):
                angle = 2 * math.pi * (i % sides) / sides
                c, s = math.cos(angle), math.sin(angle)
                origin = here((0.0, 0.0, 0.0))
                normal = add(here((dy * c, -dr, dy * s)), origin, -1)
                ring.append(self.vertex(here((r * c, y, r * s)), normalize(normal),
                                        (i / sides, lengths[k] / lengths[-1])))
            rings.append(ring)
        for k in range(len(rings) - 1):
            for i in range(sides):
                a, b, c, d = rings[k][i], rings[k][i + 1], rings[k + 1][i], rings[k + 1][i + 1]
                if profile[k][0] != 0:
                    self.triangle(a, d, b)
                if profile[k + 1][0] != 0:
                    self.triangle(a, c, d)

    def tube(self, path, radius, sides):
        """A tube around the polyline path; radius is a function of [0, 1] along it. Its ends are open."""
        rings, side = [], None
        for k, p in enumerate(path):
            along = normalize(add(path[min(k + 1, len(path) - 1)], path[max(k - 1, 0)], -1))
            if side is None:
                side = cross(along, (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 else (1.0, 0.0, 0.0))
            side = normalize(add(side, along, -dot(side, along)))
            other = cross(along, side)
            r, ring = radius(k / (len(path) - 1)), []
            for i in range(sides + 1):
                angle = 2 * math.pi * (i % sides) / sides
                n = add(scaled(side, math.cos(angle)), other, math.sin(angle))
                ring.append(self.vertex(add(p, n, r), n, (i / sides, k / (len(path) - 1))))
            rings.append(ring)
        for k in range(len(rings) - 1):
            for i in range(sides):
                a, b, c, d = rings[k][i], rings[k][i + 1], rings[k + 1][i], rings[k + 1][i + 1]
                self.triangle(a, b, d)
                self.triangle(a, d, c)

    def write(self, path):
        header = (f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {self.count}\n"
                  + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
                  + f"element face {len(self.faces) // 13}\nproperty list uchar int vertex_indices\nend_header\n")
        write_file(path, header.encode(), self.vertices.tobytes(), self.faces)


def write_vessel(folder, name, dry_outside, dry_inside, wet, sides, climb=0.05):
    """A glass with liquid as three surfaces that meet on one circle and close without a gap: NAME.ply, glass to air;
    NAME-liquid.ply, liquid to glass; NAME-surface.ply, liquid to air. Their normals point to what is named last.

    dry_outside: profile from the axis below up to the lip; dry_inside: on down to the liquid's border;
    wet: from there to the axis. The liquid climbs the glass by `climb` at its border."""
    def write(suffix, profile):
        mesh = Mesh()
        mesh.lathe(profile, sides)
        mesh.write(os.path.join(folder, name + suffix + ".ply"))

    r, y = wet[0]
    write("", dry_outside + dry_inside[1:])
    write("-liquid", [(max(radius, 0.0), height) for radius, height in wet[::-1]])
    steps = (0, 0.2, 0.5, 1, 2, 3, 5)
    write("-surface", [(r - climb * s, y - climb * (1 - math.exp(-s))) for s in steps] + [(0.0, y - climb)])


def write_file(path, *parts):
    """Writes beside the name, then renames."""
    partial = f"{path}.{os.getpid()}.part"
    with open(partial, "wb") as file:
        for part in parts:
            file.write(part)
    os.replace(partial, path)


def output_folder(script):
    """Where a generator writes: the folder named by its only argument, or generated/ beside it; made if need be."""
    here = os.path.dirname(os.path.abspath(script))
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "generated")
    os.makedirs(folder, exist_ok=True)
    return folder
