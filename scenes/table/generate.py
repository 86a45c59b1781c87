#!/usr/bin/env python3
"""Writes what stands on the table, solids of revolution, and the textures of table and mat, to generated/.

The glass is made of the interfaces between its substances, each mesh a border of exactly two of them: glass_air (the
outside, the rim and the inside above the water), glass_water (the inside below it; its normals point into the water)
and water_air (the water's surface)."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from mesh import lathe  # noqa: E402
from picture import fractal, hash01, mix, write_png  # noqa: E402

OUT = os.path.join(HERE, "generated")

# Profiles, radius and height [dm]; a point given twice is a corner.
BOWL = [(0, 0), (0.62, 0), (0.62, 0), (0.66, 0.10), (0.66, 0.10), (1.10, 0.34), (1.42, 0.72), (1.56, 1.06), (1.60, 1.10),
        (1.54, 1.10), (1.34, 0.74), (1.02, 0.42), (0.5, 0.23), (0, 0.20)]
PLATE = [(0, 0.02), (0.80, 0.02), (0.80, 0.02), (0.98, 0.06), (1.46, 0.20), (1.50, 0.23), (1.45, 0.24), (1.00, 0.12),
         (0.86, 0.09), (0, 0.08)]
WATER_LINE = (0.505, 1.25)
OUTSIDE = [(0, 0), (0.36, 0), (0.40, 0.03), (0.42, 0.20), (0.49, 0.70), (0.58, 1.80), (0.60, 2.00), (0.585, 2.02)]
RIM_TO_WATER = [(0.585, 2.02), (0.57, 2.00), (0.55, 1.80), WATER_LINE]
INSIDE = [(0, 0.16), (0.30, 0.17), (0.37, 0.22), (0.40, 0.34), (0.46, 0.80), WATER_LINE]
SURFACE = [(0, 1.22), (0.42, 1.22), (0.48, 1.228), WATER_LINE]

lathe(BOWL).write_ply(os.path.join(OUT, "bowl.ply"))
lathe(PLATE).write_ply(os.path.join(OUT, "plate.ply"))
lathe(OUTSIDE + RIM_TO_WATER[1:]).write_ply(os.path.join(OUT, "glass_air.ply"))
lathe(INSIDE, inward=True).write_ply(os.path.join(OUT, "glass_water.ply"))
lathe(SURFACE, inward=True).write_ply(os.path.join(OUT, "water_air.ply"))


def wood(x, y, size=256, planks=5):
    """Planks along u; the grain is noise that is stretched along them."""
    u, v = (x + 0.5) / size, (y + 0.5) / size
    plank = math.floor(planks * v)
    shift = hash01(plank, 9)
    grain = fractal(4 * (u + shift), 60 * v, 4, 64, plank)
    rings = 0.5 + 0.5 * math.sin(40 * (v + 0.05 * fractal(3 * (u + shift), 6 * v, 2, 64, 7 + plank)))
    color = mix((0.40, 0.25, 0.15), (0.66, 0.46, 0.30), 0.65 * grain + 0.2 * rings + 0.25 * shift)
    joint = abs(planks * v - round(planks * v))
    return mix((0.16, 0.09, 0.05), color, min(1.0, joint / 0.02))


def gingham(x, y, size=128, checks=8):
    """Two sets of stripes, woven."""
    a, b = (math.floor(2 * checks * (c + 0.5) / size) % 2 for c in (x, y))
    thread = 0.94 + 0.06 * ((x + y) % 2)
    return tuple(thread * c for c in ((0.93, 0.92, 0.88), (0.58, 0.68, 0.76), (0.24, 0.40, 0.55))[a + b])


write_png(os.path.join(OUT, "wood.png"), 256, 256, wood)
write_png(os.path.join(OUT, "gingham.png"), 128, 128, gingham)
