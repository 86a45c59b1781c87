#!/usr/bin/env python3
"""Writes generated/ring.ply, a ring with a wavy outline, and generated/stopper.ply, the stopper of a carafe."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from mesh import lathe, surface  # noqa: E402


def ring(u, v):
    """A torus around z that swells six times."""
    a, b = 2 * math.pi * u, 2 * math.pi * v
    tube = 0.27 + 0.06 * math.cos(6 * a)
    r = 0.66 + tube * math.cos(b)
    return (r * math.cos(a), r * math.sin(a), tube * math.sin(b))


STOPPER = [(0, 0), (0.24, 0), (0.24, 0), (0.30, 0.42), (0.30, 0.42), (0.42, 0.46), (0.44, 0.52), (0.34, 0.58),
           (0.20, 0.66), (0.24, 0.80), (0.46, 0.98), (0.56, 1.24), (0.46, 1.50), (0.24, 1.66), (0, 1.72)]

surface(ring, 192, 64).write_ply(os.path.join(HERE, "generated", "ring.ply"))
lathe(STOPPER, 96).write_ply(os.path.join(HERE, "generated", "stopper.ply"))
