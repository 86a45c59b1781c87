#!/usr/bin/env python3
"""Writes the models and textures of the still life: vase and water, flowers, cup, curtain, wallpaper, wood.

Usage: generate.py [FOLDER]; the default is generated/ beside this script. One unit is ten centimetres; the table's
top is at y = 0, the vase stands in the origin.
"""
import math
import os
import random
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
from modelling import Mesh, bezier, output_folder, placed, rotation, smooth, write_vessel  # noqa: E402
from painting import Noise, mix, step, write_png  # noqa: E402

SIDES = 128
OUTER = [(0.62, 0.03), (0.78, 0.14), (0.96, 0.50), (1.03, 0.95), (0.97, 1.40), (0.80, 1.80), (0.58, 2.16), (0.47, 2.50),
         (0.49, 2.82), (0.60, 3.08), (0.68, 3.20)]
LIP = [(0.68, 3.20), (0.675, 3.235), (0.64, 3.23)]
INNER = [(0.64, 3.23), (0.55, 3.06), (0.44, 2.80), (0.42, 2.50), (0.52, 2.14), (0.74, 1.76)]
WET = [(0.74, 1.76), (0.90, 1.38), (0.96, 0.95), (0.89, 0.54), (0.70, 0.27), (0.45, 0.20), (0.20, 0.19), (0.0, 0.19)]
CUP = [(0.0, 0.05), (0.40, 0.05), (0.44, 0.0), (0.50, 0.0), (0.56, 0.05), (0.62, 0.30), (0.655, 0.70), (0.67, 1.22),
       (0.655, 1.25), (0.635, 1.22), (0.62, 0.70), (0.585, 0.32), (0.50, 0.14), (0.0, 0.11)]


def write_vase(folder):
    spline = smooth(INNER + WET[1:], 8)
    shore = 8 * (len(INNER) - 1)
    foot = [(0.0, 0.06), (0.3, 0.05), (0.5, 0.02), (0.55, 0.0), (0.6, 0.0)]
    write_vessel(folder, "vase", foot + smooth(OUTER, 8) + smooth(LIP, 4)[1:], spline[:shore + 1], spline[shore:],
                 SIDES)


def petal(rng, length, width, rise, droop, cup):
    """Controls of a petal that grows along +x from the origin, with +y above; u across, v along."""
    rows = []
    for j in range(4):
        s = j / 3
        w = width * (0.16, 0.75, 0.95, 0.55)[j]
        row = []
        for i in range(4):
            t = (i - 1.5) / 1.5
            x = length * (s - 0.25 * max(droop, 0) * s ** 3)
            y = length * (rise * s - droop * s ** 2.2) + cup * w * t * t * (1 if j < 3 else -0.6)
            wobble = 0.10 * width * (j > 0)
            row.append((x + rng.uniform(-1, 1) * wobble, y + rng.uniform(-1, 1) * wobble * 1.4, -t * w))
        rows.append(row)
    return rows


def write_flowers(folder):
    rng = random.Random(4)
    petals = (Mesh(), Mesh())
    leaves, stems, hearts = Mesh(), Mesh(), Mesh()
    # Where a head is, where it looks (turn about y, tilt from upright), size, kind; how withered.
    heads = [((-0.75, 4.75, 0.25), 200, 48, 1.00, 0, 0.75), ((0.30, 5.15, -0.1), 20, 35, 0.95, 1, 0.65),
             ((1.25, 4.30, 0.2), -20, 75, 0.95, 0, 1.0), ((-1.75, 3.70, 0.3), 175, 112, 0.9, 1, 1.2),
             ((0.25, 4.05, 0.75), -75, 62, 0.85, 0, 0.8), ((2.05, 2.75, 0.5), -25, 150, 0.8, 1, 1.35)]
    for k, (p, turn, tilt, size, kind, age) in enumerate(heads):
        facing = placed(rotation("z", -tilt), rotation("y", turn))
        place = placed(facing, p)
        for layer, (count, scale, rise) in enumerate(((9, 1.0, 0.10), (8, 0.82, 0.55), (5, 0.55, 1.05))):
            for i in range(count):
                length = size * scale * rng.uniform(0.72, 0.95)
                controls = petal(rng, length, 0.34 * size * (1.15 - 0.15 * layer), rise + rng.uniform(-0.1, 0.1),
                                 age * rng.uniform(0.45, 1.0), rng.uniform(0.2, 0.6))
                angle = 360 * (i + rng.uniform(-0.25, 0.25)) / count + 20 * layer
                petals[kind].patch(controls, 7, 11, placed((0.05 * size, 0, 0), rotation("y", angle), place))
        ball = [(0.16 * size * math.sin(math.pi * j / 12), 0.06 - 0.13 * size * math.cos(math.pi * j / 12))
                for j in range(13)]
        hearts.lathe([(0.0, ball[0][1])] + ball[1:-1] + [(0.0, ball[-1][1])], 24, place)

        up = facing((0, 1, 0))
        angle = 2.4 * k + 0.5
        foot = (0.42 * math.cos(angle), 0.30 + 0.05 * k, 0.42 * math.sin(angle))
        neck = (-0.17 * math.cos(angle) * 0.6 + 0.10 * p[0], 2.6, -0.17 * math.sin(angle) + 0.08 * p[2])
        below = tuple(p[i] - 0.08 * up[i] for i in range(3))
        bend = tuple(p[i] - 0.9 * up[i] + (0, 0.35, 0)[i] for i in range(3))
        path = [bezier((foot, tuple(foot[i] + (neck[i] - foot[i]) * 0.4 for i in range(3)),
                        tuple(foot[i] + (neck[i] - foot[i]) * 0.75 for i in range(3)), neck), t / 14)
                for t in range(14)]
        lift = (neck[0] * 1.25, 3.3, neck[2] * 1.25)
        path += [bezier((neck, lift, bend, below), t / 20) for t in range(21)]
        stems.tube(path, lambda s: 0.05 - 0.014 * s, 12)
        for s, side in ((20, 1), (24, -1))[:1 + k % 2]:
            place_leaf = placed(rotation("z", rng.uniform(-35, 10)), rotation("y", turn + side * rng.uniform(60, 120)),
                                path[s])
            controls = petal(rng, rng.uniform(1.0, 1.35), 0.30, 0.35, rng.uniform(0.7, 1.3), 0.35)
            leaves.patch(controls, 7, 14, place_leaf)
    for x, z, turn, kind in ((-1.55, 1.25, 30, 0), (0.75, 1.9, 140, 1), (-0.55, 2.1, 250, 0), (2.9, 1.6, 80, 0),
                             (-2.6, 0.4, 320, 1)):
        controls = petal(rng, 0.75, 0.32, 0.12, 0.12, 0.55)
        petals[kind].patch(controls, 7, 11, placed(rotation("y", turn), (x, 0.05, z)))
    for name, mesh in (("petals-rose", petals[0]), ("petals-straw", petals[1]), ("leaves", leaves), ("stems", stems),
                       ("hearts", hearts)):
        mesh.write(os.path.join(folder, name + ".ply"))


def write_cup(folder):
    mesh = Mesh()
    profile = [(max(r, 0.0), y) for r, y in smooth(CUP, 6)]
    mesh.lathe(profile, SIDES)
    handle = smooth([(0.60, 1.02, 0), (0.80, 1.06, 0), (1.02, 0.98, 0), (1.10, 0.74, 0), (1.02, 0.46, 0),
                     (0.82, 0.32, 0), (0.58, 0.30, 0)], 8)
    mesh.tube(handle, lambda s: 0.075, 24)
    mesh.write(os.path.join(folder, "cup.ply"))


def write_curtain(folder):
    """u runs along the rail, v upwards; folds are narrow at the top and swing wide below."""
    def point(u, v):
        deep = 0.13 + 0.17 * (1 - v)
        phase = 2 * math.pi * (6.5 * u + 0.22 * math.sin(5 * u + 1.5 * v))
        fold = math.sin(phase) + 0.25 * math.sin(2 * phase + 1)
        along = 2.5 * u - 0.05 * math.cos(phase) * (1 - v)
        sag = 0.35 * (1 - v) * u
        return (-4.9 + 0.80 * along + 0.6 * deep * fold - sag, -1.2 + 9 * v, -2.45 + 0.60 * along - 0.8 * deep * fold)
    mesh = Mesh()
    mesh.surface(point, 220, 24)
    mesh.write(os.path.join(folder, "curtain.ply"))


def write_textures(folder):
    noise = Noise(3)

    def outline(u, v):
        """Above 0 inside the petal: wide beyond the middle, a ragged tip."""
        half = 0.47 * (math.sin(math.pi * min(v, 1) ** 0.8)) ** 0.45 * (0.55 + 0.45 * v)
        ragged = 0.07 * noise.fractal(9 * u, 9 * v, 2.5, 3) * (0.3 + v)
        return half + ragged - abs(u - 0.5)

    def petal_color(base, tip, rim):
        def color(u, v):
            vein = 0.5 + 0.5 * noise.fractal(26 * (u - 0.5) / (0.35 + v), 2.5 * v, 7.0, 3)
            blotch = noise.fractal(5 * u, 5 * v, 11.0, 3)
            c = mix(mix(base, tip, v + 0.4 * blotch), rim, 1.1 * step(0.14, -0.02, outline(u, v)) + 0.5 * blotch)
            return tuple(x * (0.72 + 0.36 * vein) for x in c)
        return color

    def petal_mask(u, v):
        hole = step(0.36, 0.44, noise.fractal(6 * u + 3, 6 * v, 19.0, 3)) * step(0.3, 0.6, v)
        return max(1 - step(-0.012, 0.012, outline(u, v)), hole, 0.06)

    def leaf_color(u, v):
        vein = step(0.035, 0.008, abs(u - 0.5)) + 0.5 * step(0.80, 0.97, math.cos(50 * (v - 0.9 * abs(u - 0.5))))
        dry = 0.5 + 0.9 * noise.fractal(4 * u, 5 * v, 23.0, 4)
        return mix(mix((0.36, 0.40, 0.19), (0.47, 0.33, 0.17), dry), (0.56, 0.50, 0.30), 0.5 * vein)

    def leaf_mask(u, v):
        half = 0.46 * math.sin(math.pi * v) ** 0.8 + 0.03 * noise.fractal(12 * u, 12 * v, 31.0, 2)
        return max(1 - step(-0.012, 0.012, half - abs(u - 0.5)),
                   step(0.42, 0.48, noise.fractal(7 * u, 7 * v, 37.0, 3)))

    def wallpaper(u, v):
        """One tile: two rosettes on a half-drop, leaves between them, faint stripes."""
        motif = 0.0
        for cx, cy in ((0.25, 0.25), (0.75, 0.75)):
            x, y = (u - cx + 0.5) % 1 - 0.5, (v - cy + 0.5) % 1 - 0.5
            r, a = math.hypot(x, y), math.atan2(y, x)
            flower = step(0.012, -0.012, r - 0.095 - 0.03 * math.cos(8 * a)) - step(0.01, -0.01, abs(r - 0.06) - 0.012)
            curve = x - 0.09 * math.sin(2 * math.pi * (y - 0.14) / 0.5)
            stalk = step(0.008, 0.0, abs(curve)) * step(0.13, 0.15, abs(y)) * step(0.42, 0.38, abs(y))
            leaf = 0.0
            for s in (1, -1):
                px, py = x - s * 0.10, y - s * 0.20
                along, across = 0.8 * px + s * 0.6 * py, -0.6 * px + s * 0.8 * py
                leaf = max(leaf, step(0.006, -0.006, abs(across) - 0.035 * math.cos(min(abs(along) / 0.075, 1) * 1.57)))
            motif = max(motif, flower, stalk, leaf)
        stripe = 0.5 + 0.5 * step(-0.5, 0.5, math.cos(8 * math.pi * u))
        paper = 1 + 0.03 * noise.fractal(64 * u, 64 * v, 5.0, 2)
        base = mix((0.42, 0.49, 0.46), (0.45, 0.52, 0.485), stripe)
        return tuple(c * paper for c in mix(base, (0.70, 0.66, 0.53), 0.8 * motif))

    def wood(u, v):
        """Boards along u."""
        board = math.floor(v * 5)
        inside = v * 5 - board
        x, y = 3.2 * u + 11.3 * board, inside * 1.1 + 3.7 * board
        ring = 9 * (y + 0.5 * noise.fractal(0.6 * x, 1.2 * y, 3.0, 3)) + 1.2 * noise.fractal(2 * x, 6 * y, 9.0, 2)
        grain = 0.5 + 0.5 * math.sin(2 * math.pi * ring)
        fibre = noise.fractal(7 * x, 90 * y, 1.0, 2)
        c = mix((0.40, 0.25, 0.15), (0.57, 0.39, 0.25), 0.25 + 0.55 * grain + 0.25 * fibre)
        gap = step(0.012, 0.004, min(inside, 1 - inside))
        tone = 0.92 + 0.12 * noise.at(5.5 * board, 2.2)
        return mix(tuple(x * tone for x in c), (0.12, 0.07, 0.04), gap)

    for name, width, height, color in (
            ("petal-rose", 128, 128, petal_color((0.80, 0.62, 0.52), (0.66, 0.28, 0.33), (0.42, 0.24, 0.17))),
            ("petal-straw", 128, 128, petal_color((0.72, 0.66, 0.40), (0.86, 0.76, 0.55), (0.55, 0.37, 0.20))),
            ("petal-mask", 192, 192, petal_mask), ("leaf", 128, 256, leaf_color), ("leaf-mask", 128, 256, leaf_mask),
            ("wallpaper", 256, 256, wallpaper), ("wood", 512, 512, wood)):
        write_png(os.path.join(folder, name + ".png"), width, height, color)


def main():
    folder = output_folder(__file__)
    write_vase(folder)
    write_flowers(folder)
    write_cup(folder)
    write_curtain(folder)
    write_textures(folder)


if __name__ == "__main__":
    main()
