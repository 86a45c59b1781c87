#!/usr/bin/env python3
"""Writes the models and textures of the holiday table: drink, ice, straw, lemons, magazine, planks, and the sky.

Usage: generate.py [FOLDER]; the default is generated/ beside this script. One unit is ten centimetres; the table's
top is at y = 0, the glass stands in the origin.
"""
import math
import os
import random
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
from modelling import Mesh, dot, normalize, output_folder, placed, rotation, smooth, write_vessel  # noqa: E402
from painting import Noise, mix, step, write_exr, write_png  # noqa: E402

SIDES = 128
OUTER = [(0.52, 0.02), (0.57, 0.10), (0.60, 0.40), (0.65, 1.00), (0.71, 1.60), (0.76, 2.06)]
LIP = [(0.76, 2.06), (0.745, 2.09), (0.72, 2.07)]
INNER = [(0.72, 2.07), (0.70, 1.88), (0.68, 1.68)]
WET = [(0.68, 1.68), (0.645, 1.30), (0.605, 0.90), (0.56, 0.50), (0.53, 0.30), (0.46, 0.20), (0.25, 0.18), (0.0, 0.18)]
SUN = normalize((-0.62, 0.50, -0.60))   # towards it
SUN_RADIUS = math.radians(7)            # a hazy sun: a large one is kind to the caustics

TITLE = ("#...#..###..#.....###..####...###..#...#.",
         "#...#.#...#.#......#...#...#.#...#.#...#.",
         "#...#.#...#.#......#...#...#.#...#..#.#..",
         "#####.#...#.#......#...#...#.#####...#...",
         "#...#.#...#.#......#...#...#.#...#...#...",
         "#...#.#...#.#......#...#...#.#...#...#...",
         "#...#..###..#####.###..####..#...#...#...")


def write_glass(folder):
    spline = smooth(INNER + WET[1:], 8)
    shore = 8 * (len(INNER) - 1)
    foot = [(0.0, 0.05), (0.25, 0.045), (0.42, 0.02), (0.46, 0.0), (0.49, 0.0)]
    write_vessel(folder, "glass", foot + smooth(OUTER, 8) + smooth(LIP, 4)[1:], spline[:shore + 1], spline[shore:],
                 SIDES, 0.03)
    straw = Mesh()
    straw.tube([(0.40 - 0.068 * k, 0.24 + 0.21 * k, 0.12 - 0.012 * k) for k in range(15)], lambda s: 0.055, 24)
    straw.write(os.path.join(folder, "straw.ply"))


def write_ice(folder):
    """Cubes with round edges: |x|^5 + |y|^5 + |z|^5 = 1, a little uneven, all of them below the surface."""
    noise, mesh = Noise(8), Mesh()

    def block(u, v):
        a, b = 2 * math.pi * u, math.pi * v
        d = (math.sin(b) * math.cos(a), math.cos(b), math.sin(b) * math.sin(a))
        r = sum(abs(c) ** 5 for c in d) ** -0.2
        r *= 1 + 0.03 * noise.fractal(2 * d[0] + 9, 2 * d[1], 2 * d[2], 2)
        return tuple(c * r for c in d)

    for size, tilt, turn, place in ((0.24, 24, 20, (-0.22, 1.27, 0.16)), (0.22, -33, 70, (0.30, 1.25, -0.18)),
                                    (0.23, 50, 35, (0.08, 0.72, 0.13))):
        mesh.surface(lambda u, v: tuple(size * c for c in block(u, 1 - v)), 48, 32,
                     placed(rotation("z", tilt), rotation("y", turn), rotation("x", tilt / 2), place))
    mesh.write(os.path.join(folder, "ice.ply"))


def write_lemons(folder):
    """The slice is a sheet of flesh in a ring of rind; its texture is polar: u is the angle, v the radius."""
    place = placed(rotation("x", 90), rotation("y", -38), (0.62, 2.16, 0.44))
    flesh, rind = Mesh(), Mesh()
    flesh.lathe([(0.0, 0.0)] + [(0.40 * k / 10, 0.0) for k in range(1, 11)], 64, place)
    rind.lathe(smooth([(0.40, -0.035), (0.445, -0.035), (0.455, 0.0), (0.445, 0.035), (0.40, 0.035)], 3), 64, place)
    noise = Noise(21)

    def lemon(u, v):
        a, b = 2 * math.pi * u, math.pi * v
        y = -math.cos(b)
        r = math.sin(b) ** 0.9 * 0.50 * (1 + 0.012 * noise.fractal(9 * math.cos(a) + 20, 9 * y, 9 * math.sin(a), 2))
        tip = 0.16 * max(abs(y) - 0.86, 0) / 0.14
        return (r * math.cos(a), y * (0.62 + tip), r * math.sin(a))

    for turn, place in ((30, (-1.42, 0.50, 0.70)), (-50, (-2.15, 0.50, -0.45))):
        rind.surface(lambda u, v: lemon(1 - u, v), 96, 64, placed(rotation("z", 84), rotation("y", turn), place))
    flesh.write(os.path.join(folder, "lemon-flesh.ply"))
    rind.write(os.path.join(folder, "lemon-rind.ply"))


def write_magazine(folder):
    """Two open halves as bicubic patches: they rise from the spine and fall to the rim, a corner curls up."""
    rng = random.Random(2)
    place = placed(rotation("y", 24), (2.15, 0.012, 1.85))
    for name, s in (("left", -1), ("right", 1)):
        mesh = Mesh()
        for sheet in range(4):
            lift = 0.016 * sheet + 0.004
            controls = []
            for j in range(4):
                z = 1.35 - 2.7 * j / 3
                curl = 0.34 if (s > 0 and j == 0) or (s < 0 and j == 3) else 0.05
                controls.append([(0.0, lift * 0.4, z), (s * 0.50, 0.34 + lift, z),
                                 (s * (1.25 + 0.02 * rng.uniform(-1, 1)), 0.02 + lift, z),
                                 (s * (1.95 - 0.02 * sheet), curl * sheet / 3 + lift * 0.6, z)])
            if s < 0:
                controls = [row[::-1] for row in controls]
            mesh.patch(controls, 24, 12, place, lambda u, v: (u, 1 - v))
        mesh.write(os.path.join(folder, f"magazine-{name}.ply"))


def cypress(folder):
    noise, mesh = Noise(14), Mesh()

    def point(u, v):
        a = -2 * math.pi * u
        r = 1.1 * math.sin(math.pi * min(v, 1) ** 0.75) ** 0.8 * (1 + 0.5 * noise.fractal(4 * math.cos(a) + 8, 9 * v,
                                                                                         4 * math.sin(a), 3))
        return (r * math.cos(a), -3 + 10.5 * v, r * math.sin(a))
    mesh.surface(point, 60, 90)
    mesh.write(os.path.join(folder, "cypress.ply"))


def write_textures(folder):
    noise, rng = Noise(6), random.Random(9)

    def straw(u, v):
        return (0.80, 0.16, 0.14) if (u + 9 * v) % 1 < 0.5 else (0.95, 0.93, 0.88)

    def lemon_flesh(u, v):
        cell = abs((u * 9) % 1 - 0.5)
        wall = max(step(0.44, 0.485, cell + 0.025 / (v + 0.05) * 0.5), step(0.90, 0.93, v), step(0.14, 0.10, v))
        juice = 0.5 + 0.5 * noise.fractal(50 * u, 4 * v, 3.0, 2)
        return mix(mix((0.93, 0.74, 0.12), (0.98, 0.88, 0.34), juice), (0.99, 0.96, 0.78), wall)

    def planks(u, v):
        board = math.floor(v * 6)
        inside = v * 6 - board
        x, y = 4 * u + 7.7 * board, 1.2 * inside + 3.1 * board
        grain = noise.fractal(1.5 * x, 24 * y, 2.0, 3)
        worn = step(0.20, 0.45, noise.fractal(1.6 * x, 5 * y, 8.0, 4) + 0.35 * grain)
        tone = 0.95 + 0.08 * noise.at(9.3 * board, 1.1)
        paint = tuple(c * tone * (1 + 0.06 * grain) for c in (0.80, 0.87, 0.86))
        wood = mix((0.56, 0.44, 0.33), (0.68, 0.57, 0.45), 0.5 + 0.6 * grain)
        return mix(mix(paint, wood, 0.75 * worn), (0.16, 0.14, 0.12), step(0.016, 0.006, min(inside, 1 - inside)))

    def picture(u, v):
        """A bay at dusk with a sail."""
        if v < 0.62:
            c = mix((0.16, 0.36, 0.62), (0.98, 0.72, 0.44), (v / 0.62) ** 1.3)
            c = mix(c, (1.0, 0.93, 0.72), step(0.085, 0.075, math.hypot(u - 0.68, 1.35 * (v - 0.48))))
            cloud = noise.fractal(3.2 * u, 11 * v, 4.0, 4)
            c = mix(c, (0.99, 0.84, 0.74), 0.8 * step(0.08, 0.45, cloud) * step(0.0, 0.2, v))
            if v > 0.60 - 0.16 * step(0.55, 0.0, u) * (0.8 + 0.5 * noise.fractal(5 * u, 1.0, 2.0, 3)):
                c = mix((0.25, 0.24, 0.36), (0.42, 0.32, 0.38), u * 2)
        else:
            wave = noise.fractal(5 * u, 50 * v * v, 6.0, 3)
            c = mix((0.86, 0.60, 0.44), (0.05, 0.23, 0.36), (v - 0.62) / 0.30 + 0.45 * wave)
        x, y = (u - 0.36) / 0.13, (v - 0.46) / 0.22
        if 0 < y < 1 and -0.85 * y < x - 0.05 < 0.62 * y and abs(x - 0.02) > 0.03:
            c = (0.96, 0.94, 0.90)
        if 1.02 < y < 1.14 and abs(x) < 0.85 - 2.0 * (y - 1.02):
            c = (0.55, 0.16, 0.12)
        return c

    def cover(u, v):
        if v < 0.03 or v > 0.97 or u < 0.04 or u > 0.97:
            return (0.95, 0.94, 0.91)
        c = picture(u, v)
        column, row = (u - 0.10) / 0.80 * 41, (v - 0.06) / 0.10 * 7
        if 0 <= column < 41 and 0 <= row < 7 and TITLE[int(row)][int(column)] == "#":
            return (0.99, 0.97, 0.93)
        return c

    lines = []
    for k in range(200):
        words, x = [], 0.0
        end = rng.uniform(0.4, 0.7) if k % 9 == 8 else 1.0
        while x < end:
            word = min(rng.uniform(0.06, 0.22), end - x)
            words.append((x, x + word))
            x += word + 0.03
        lines.append(words)

    def article(u, v):
        paper = (0.95, 0.94, 0.91)
        if 0.08 < v < 0.115 and 0.10 < u < 0.72 or 0.13 < v < 0.155 and 0.10 < u < 0.55:
            return (0.72, 0.20, 0.14) if noise.at(60 * u, 3.0 if v < 0.12 else 8.0) > -0.35 else paper
        if 0.52 < u < 0.92 and 0.22 < v < 0.50:
            return picture((u - 0.52) / 0.40, 0.35 + 0.6 * (v - 0.22) / 0.28)
        column = 0 if 0.08 < u < 0.48 else 1 if 0.52 < u < 0.92 else -1
        if column < 0 or not 0.22 < v < 0.93:
            return paper
        row = (v - 0.22) / 0.0155
        if 0.25 < row % 1 < 0.72:
            x = (u - (0.08, 0.52)[column]) / 0.40
            if any(a <= x <= b for a, b in lines[int(row) + 60 * column]):
                return (0.34, 0.33, 0.34)
        return paper

    def sky(u, v):
        """Rows from the zenith down; u = 0 is towards -z, 1/4 towards +x. A sea below the horizon."""
        theta, phi = math.pi * v, 2 * math.pi * u
        d = (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
        toward = dot(d, SUN)
        if d[1] > 0:
            c = mix((0.74, 0.80, 0.86), (0.14, 0.33, 0.74), d[1] ** 0.4)
            cloud = noise.fractal(3 * d[0] / (d[1] + 0.25), 3 * d[2] / (d[1] + 0.25), 1.0, 5)
            c = mix(c, (1.05, 1.0, 0.95), 0.75 * step(0.08, 0.5, cloud) * step(0.02, 0.2, d[1]))
            c = tuple(p + q * 1.2 * max(toward, 0) ** 12 for p, q in zip(c, (1.0, 0.8, 0.5)))
            edge = step(SUN_RADIUS * 1.1, SUN_RADIUS * 0.9, math.acos(min(max(toward, -1), 1)))
            return tuple(p + edge * q for p, q in zip(c, (78.0, 64.0, 45.0)))
        distance = 1 / (0.03 - d[1])
        wave = noise.fractal(0.3 * distance * d[0] * 4, 0.3 * distance * d[2] * 4, 5.0, 3)
        c = mix((0.30, 0.52, 0.62), (0.03, 0.20, 0.30), 0.15 + (-d[1]) ** 0.4 + 0.3 * wave)
        return c

    for name, width, height, color in (
            ("straw", 64, 256, straw), ("lemon-flesh", 256, 64, lemon_flesh), ("planks", 512, 512, planks),
            ("magazine-left", 240, 330, cover), ("magazine-right", 300, 410, article)):
        write_png(os.path.join(folder, name + ".png"), width, height, color)
    write_exr(os.path.join(folder, "sky.exr"), 384, 192, sky)


def main():
    folder = output_folder(__file__)
    write_glass(folder)
    write_ice(folder)
    write_lemons(folder)
    write_magazine(folder)
    cypress(folder)
    write_textures(folder)


if __name__ == "__main__":
    main()
