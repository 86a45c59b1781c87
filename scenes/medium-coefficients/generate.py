#!/usr/bin/env python3
"""Writes piece.ply: a closed surface of revolution in the shape of a chess bishop, 2.9 units tall, its base at y = 0.

Usage: generate.py [FOLDER]; the default is generated/ beside this script.
"""
import math
import os
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
from modelling import Mesh, output_folder, smooth  # noqa: E402

OUTLINE = [(0.80, 0.05), (0.86, 0.16), (0.80, 0.27), (0.66, 0.33), (0.70, 0.42), (0.62, 0.52), (0.44, 0.70),
           (0.33, 1.00), (0.27, 1.35), (0.25, 1.58), (0.40, 1.65), (0.44, 1.71), (0.38, 1.77), (0.28, 1.82),
           (0.36, 1.95), (0.415, 2.12), (0.37, 2.32), (0.24, 2.52), (0.12, 2.62), (0.10, 2.66)]
KNOB, RADIUS = 2.76, 0.14


def main():
    profile = [(0.0, 0.0), (0.25, 0.0), (0.5, 0.0), (0.74, 0.0)] + smooth(OUTLINE, 6)
    for k in range(13):
        angle = math.radians(-44 + 134 * k / 12)
        profile.append((RADIUS * math.cos(angle) if k < 12 else 0.0, KNOB + RADIUS * math.sin(angle)))
    mesh = Mesh()
    mesh.lathe(profile, 96)
    mesh.write(os.path.join(output_folder(__file__), "piece.ply"))


if __name__ == "__main__":
    main()
