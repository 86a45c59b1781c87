#!/usr/bin/env python3
"""Writes knot.ply: a ribbed tube along a trefoil knot, as a binary PLY with vertex normals.

Usage: generate.py [OUT.ply [RINGS SIDES]]; the default of 1200 x 96 gives 230400 triangles.
"""
import array
import math
import os
import sys

TURNS, LOBES = 2, 3        # of the knot around its axis and through its middle
MAJOR, MINOR = 1.0, 0.42   # radii of the torus that the knot lies on
TUBE, RIB = 0.27, 0.13     # radius of the tube; height of its ribs relative to that
RIBS, TWIST = 7, 9         # ribs around the tube; how often they wind around it along the knot


def add(a, b, s=1.0):
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalize(a):
    length = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / length, a[1] / length, a[2] / length)


def curve(t):
    """Point of the knot, t in [0, 1); the axis of the torus is z."""
    a, b = 2 * math.pi * TURNS * t, 2 * math.pi * LOBES * t
    r = MAJOR + MINOR * math.cos(b)
    return (r * math.cos(a), r * math.sin(a), MINOR * math.sin(b))


def frame(t):
    """Centre, and two unit vectors across the tube; the first leans away from the axis, so the ends meet."""
    h = 1e-4
    centre = curve(t)
    along = normalize(add(curve(t + h), curve(t - h), -1))
    outward = normalize(cross(along, cross((centre[0], centre[1], 0.0), along)))
    return centre, outward, cross(along, outward)


def ring(t, sides):
    centre, u, v = frame(t)
    points = []
    for j in range(sides):
        angle = 2 * math.pi * j / sides
        radius = TUBE * (1 + RIB * math.cos(RIBS * angle + 2 * math.pi * TWIST * t))
        points.append(add(add(centre, u, radius * math.cos(angle)), v, radius * math.sin(angle)))
    return points


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    out = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "knot.ply")
    rings, sides = (int(n) for n in sys.argv[2:4]) if len(sys.argv) > 3 else (1200, 96)
    points = [ring(i / rings, sides) for i in range(rings)]

    # Normals by central differences over the neighbouring vertices.
    vertices = array.array("f")
    for i in range(rings):
        before, after = points[i - 1], points[(i + 1) % rings]
        for j in range(sides):
            along = add(after[j], before[j], -1)
            around = add(points[i][(j + 1) % sides], points[i][j - 1], -1)
            vertices.extend(points[i][j])
            vertices.extend(normalize(cross(around, along)))

    faces = bytearray()
    for i in range(rings):
        for j in range(sides):
            a, b = i * sides + j, i * sides + (j + 1) % sides
            c, d = (i + 1) % rings * sides + j, (i + 1) % rings * sides + (j + 1) % sides
            for corners in ((a, b, d), (a, d, c)):
                faces += b"\x03" + array.array("i", corners).tobytes()

    header = (f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {rings * sides}\n"
              + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
              + f"element face {2 * rings * sides}\nproperty list uchar int vertex_indices\nend_header\n")
    partial = f"{out}.{os.getpid()}.part"
    with open(partial, "wb") as file:
        file.write(header.encode())
        file.write(vertices.tobytes())
        file.write(faces)
    os.replace(partial, out)


if __name__ == "__main__":
    main()
