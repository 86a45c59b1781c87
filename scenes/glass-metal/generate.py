#!/usr/bin/env python3
"""Writes ball.ply: a unit sphere of 2 * RINGS * (RINGS - 1) triangles with vertex normals, as a binary PLY.

Usage: generate.py [OUT.ply [RINGS]]; the default of 101 gives 20200 triangles.
"""
import array
import math
import os
import sys


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    out = sys.argv[1] if len(sys.argv) > 1 else os.path.join(here, "ball.ply")
    rings = int(sys.argv[2]) if len(sys.argv) > 2 else 101
    points = [(0.0, 1.0, 0.0)]
    for i in range(1, rings):
        theta = math.pi * i / rings
        for j in range(rings):
            phi = 2 * math.pi * j / rings
            points.append((math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi)))
    points.append((0.0, -1.0, 0.0))

    def corner(i, j):  # vertex j of ring i; the rings 0 and `rings` are the poles
        return 0 if i == 0 else len(points) - 1 if i == rings else 1 + (i - 1) * rings + j % rings

    triangles = []
    for i in range(rings):
        for j in range(rings):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            triangles += [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]

    vertices = array.array("f", (x for p in points for x in p + p))
    faces = bytearray()
    for t in triangles:
        faces += b"\x03" + array.array("i", t).tobytes()
    header = (f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {len(points)}\n"
              + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
              + f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    partial = f"{out}.{os.getpid()}.part"
    with open(partial, "wb") as file:
        file.write(header.encode() + vertices.tobytes() + faces)
    os.replace(partial, out)


if __name__ == "__main__":
    main()
