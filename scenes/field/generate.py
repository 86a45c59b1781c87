#!/usr/bin/env python3
"""Writes what the scene `field` is made of: clay.ply, chalk.ply and moss.ply (27 bumpy balls in all, 249480 triangles
with vertex normals, as binary PLY) and sky.exr (a clear sky with a sun of 1.6 degrees, 1024 x 512, float32).

Usage: generate.py [FOLDER]; the default is the folder of this script.
"""
import array
import math
import os
import random
import struct
import sys

RINGS, SIDES = 67, 70           # of a ball: 2 * (RINGS - 1) * SIDES triangles
WIDTH, HEIGHT = 1024, 512       # of the sky
SUN = (0.45, 0.55, 0.35)        # towards it
SUN_RADIUS = math.radians(0.8)
SUN_RADIANCE = (7000.0, 6100.0, 4700.0)


def normalize(a):
    length = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    return (a[0] / length, a[1] / length, a[2] / length)


def write(path, *parts):
    partial = f"{path}.{os.getpid()}.part"
    with open(partial, "wb") as file:
        for part in parts:
            file.write(part)
    os.replace(partial, path)


class Ball:
    """A sphere whose radius swings with direction: a sum of plane waves."""

    def __init__(self, rng, centre, radius):
        self.centre, self.radius = centre, radius
        self.waves = []
        for k in range(6):
            axis = normalize([rng.gauss(0, 1) for _ in range(3)])
            frequency = 3.0 * 1.7 ** k
            self.waves.append((axis, frequency, rng.uniform(0, 6.28), 0.16 / frequency))

    def vertex(self, d):
        """Position and normal (of the level set |p| / r(p) = 1) in direction d."""
        bump, slope = 1.0, [0.0, 0.0, 0.0]
        for axis, frequency, phase, height in self.waves:
            x = frequency * (axis[0] * d[0] + axis[1] * d[1] + axis[2] * d[2]) + phase
            bump += height * math.sin(x)
            s = height * frequency * math.cos(x)
            slope = [slope[0] + s * axis[0], slope[1] + s * axis[1], slope[2] + s * axis[2]]
        along = slope[0] * d[0] + slope[1] * d[1] + slope[2] * d[2]
        normal = normalize([bump * d[i] - (slope[i] - along * d[i]) for i in range(3)])
        return [self.centre[i] + self.radius * bump * d[i] for i in range(3)] + list(normal)


def write_balls(path, balls):
    vertices, faces, count = array.array("f"), bytearray(), 0
    for ball in balls:
        first = count
        for i in range(RINGS + 1):
            theta = math.pi * i / RINGS
            for j in range(SIDES if 0 < i < RINGS else 1):
                phi = 2 * math.pi * j / SIDES
                vertices.extend(ball.vertex((math.sin(theta) * math.sin(phi), math.cos(theta),
                                             math.sin(theta) * math.cos(phi))))
                count += 1

        def corner(i, j):
            return first if i == 0 else count - 1 if i == RINGS else first + 1 + (i - 1) * SIDES + j % SIDES

        for i in range(RINGS):
            for j in range(SIDES):
                a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
                for t in ((a, b, c), (a, c, d)):
                    if len(set(t)) == 3:
                        faces += b"\x03" + array.array("i", t).tobytes()
    header = (f"ply\nformat binary_{sys.byteorder}_endian 1.0\nelement vertex {count}\n"
              + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
              + f"element face {len(faces) // 13}\nproperty list uchar int vertex_indices\nend_header\n")
    write(path, header.encode(), vertices.tobytes(), faces)


def sky(d):
    """Radiance from direction d."""
    up = max(d[1], 0.0)
    if d[1] < 0:
        return (0.12, 0.11, 0.10)
    haze = (1 - up) ** 4
    return (0.22 + 0.9 * haze, 0.42 + 0.75 * haze, 0.95 + 0.35 * haze)


def write_sky(path):
    """Uncompressed scanline OpenEXR; u = atan2(x, -z) / 2 pi, row 0 at the zenith."""
    sun = normalize(SUN)
    rows = []
    for y in range(HEIGHT):
        theta = math.pi * y / (HEIGHT - 1)
        channels = [array.array("f") for _ in range(3)]
        for x in range(WIDTH):
            phi = 2 * math.pi * (x + 0.5) / WIDTH
            d = (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
            color = sky(d)
            if d[0] * sun[0] + d[1] * sun[1] + d[2] * sun[2] > math.cos(SUN_RADIUS):
                color = SUN_RADIANCE
            for c in range(3):
                channels[c].append(color[c])
        if sys.byteorder == "big":
            for c in channels:
                c.byteswap()
        rows.append(b"".join(channels[c].tobytes() for c in (2, 1, 0)))  # in alphabetical order: B G R

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    channel_list = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = (struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channel_list)
              + attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window)
              + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
              + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
              + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
              + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")
    start, size = len(header) + 8 * HEIGHT, 8 + 12 * WIDTH
    table = b"".join(struct.pack("<Q", start + y * size) for y in range(HEIGHT))
    write(path, header, table, *(struct.pack("<ii", y, len(row)) + row for y, row in enumerate(rows)))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    rng = random.Random(11)
    balls = []
    while len(balls) < 27:
        radius = rng.uniform(0.45, 0.95)
        x, z = rng.uniform(-5.2, 5.2), rng.uniform(-6.5, 3.0)
        if all(math.hypot(x - b.centre[0], z - b.centre[2]) > 1.02 * (radius + b.radius) for b in balls):
            balls.append(Ball(rng, (x, 0.9 * radius, z), radius))
    for k, name in enumerate(("clay", "chalk", "moss")):
        write_balls(os.path.join(folder, name + ".ply"), balls[k::3])
    write_sky(os.path.join(folder, "sky.exr"))


if __name__ == "__main__":
    main()
