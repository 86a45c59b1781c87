#!/usr/bin/env python3
"""Writes smoke.vol: a rising, widening column of smoke as a grid of densities within [0, 1], and burner.ply.

Usage: generate.py [FOLDER]; the default is generated/ beside this script.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
from modelling import Mesh, output_folder, smooth  # noqa: E402
from painting import Noise, step, write_vol  # noqa: E402

NX, NY, NZ = 56, 112, 56   # voxels; y is up
BOWL = [(0.0, 0.0), (0.15, 0.0), (0.3, 0.0), (0.33, 0.04), (0.27, 0.09), (0.13, 0.16), (0.11, 0.30), (0.2, 0.37),
        (0.36, 0.46), (0.44, 0.60), (0.45, 0.72), (0.42, 0.74), (0.39, 0.70), (0.36, 0.60), (0.25, 0.52), (0.0, 0.50)]


def density(noise, x, y, z):
    """A plume: its middle sways, its radius grows, and noise that is dragged upwards eats its border."""
    sway = 0.30 * y * noise.at(7.3, 2.9 * y)
    swirl = 0.24 * y * noise.at(1.7, 3.1 * y, 5.0)
    warp = 0.16 * (0.2 + y)
    wx = warp * noise.fractal(5 * x, 4.5 * y - 3, 5 * z, 2)
    wz = warp * noise.fractal(5 * x + 9, 4.5 * y, 5 * z + 4, 2)
    radius = math.hypot(x - 0.5 - sway + wx, z - 0.5 - swirl + wz)
    border = 0.05 + 0.27 * y ** 0.8
    body = 1 - radius / border
    if body <= -0.2:
        return 0.0
    ragged = body + 1.1 * noise.fractal(7 * (x + wx), 5 * y, 7 * (z + wz), 3) * (0.35 + y)
    fade = step(0.0, 0.03, y) * (1 - step(0.62, 0.97, y)) * step(0.0, 0.06, min(x, 1 - x, z, 1 - z))
    return min(step(0.05, 0.75, ragged) * fade * (1.25 - y) * 0.8, 1.0)


def main():
    folder, noise = output_folder(__file__), Noise(11)
    write_vol(os.path.join(folder, "smoke.vol"), NX, NY, NZ, lambda x, y, z: density(noise, x, y, z))
    mesh = Mesh()
    profile = smooth(BOWL, 5)
    mesh.lathe([(max(r, 0.0), max(y, 0.0)) for r, y in profile], 96)
    mesh.write(os.path.join(folder, "burner.ply"))


if __name__ == "__main__":
    main()
