#!/usr/bin/env python3
"""Writes generated/lantern.ply: a pleated paper lantern, open above and below; and generated/book.ply, an open book."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from mesh import surface  # noqa: E402

PLEATS = 14


def lantern(u, v):
    """Height 2 v; the rings that hold it pull the paper in."""
    belly = 0.34 + 0.56 * math.sin(math.pi * (0.08 + 0.84 * v)) ** 0.75
    fold = 0.5 - 0.5 * math.cos(2 * math.pi * PLEATS * v)
    a = 2 * math.pi * u
    r = belly * (0.93 + 0.07 * fold)
    return (r * math.cos(a), 2 * v, -r * math.sin(a))


def page(u, v):
    """One half of an open book: 1 wide, 1.4 deep."""
    return (u, 0.02 + 0.10 * math.sin(math.pi * abs(u) ** 0.6) * (1 - 0.35 * u), 1.4 * (0.5 - v))


surface(lantern, 96, 16 * PLEATS).write_ply(os.path.join(HERE, "generated", "lantern.ply"))
book = surface(page, 32, 4)
book.append(surface(page, 32, 4), lambda p: (-p[0], p[1], -p[2]), lambda n: (-n[0], n[1], -n[2]))
book.write_ply(os.path.join(HERE, "generated", "book.ply"))
