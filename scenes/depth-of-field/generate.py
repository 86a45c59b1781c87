#!/usr/bin/env python3
"""Writes generated/pawn.ply, a chess pawn, and generated/dusk.hdr, an environment of 48 x 24 pixels."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from mesh import lathe  # noqa: E402
from picture import direction, hash01, mix, write_hdr  # noqa: E402

OUT = os.path.join(HERE, "generated")
PAWN = [(0, 0), (0.40, 0), (0.40, 0), (0.42, 0.06), (0.38, 0.14), (0.38, 0.14), (0.30, 0.20), (0.32, 0.27), (0.24, 0.34),
        (0.24, 0.34), (0.15, 0.56), (0.12, 0.80), (0.14, 0.86), (0.14, 0.86), (0.24, 0.90), (0.12, 0.95), (0.12, 0.95),
        (0.20, 1.02), (0.245, 1.14), (0.19, 1.27), (0, 1.36)]


def dusk(x, y, width=48, height=24):
    """Afterglow at the horizon, dark blue above, windows of a town in the row above the horizon, dark below."""
    d = direction((x + 0.5) / width, y / (height - 1))
    if y == 11 and hash01(x, 3) < 0.4:
        warm = hash01(x, 4)
        return tuple(1.6 * c for c in mix((1.0, 0.62, 0.25), (0.75, 0.85, 1.0), warm ** 3))
    if d[1] < 0:
        return (0.05, 0.045, 0.05)
    glow = max(0.0, 1 - 2.2 * d[1]) ** 2
    return mix((0.10, 0.17, 0.36), mix((0.70, 0.28, 0.15), (0.30, 0.20, 0.34), 0.5 + 0.5 * d[0]), glow)


lathe(PAWN, 48, 6).write_ply(os.path.join(OUT, "pawn.ply"))
write_hdr(os.path.join(OUT, "dusk.hdr"), 48, 24, dusk)
