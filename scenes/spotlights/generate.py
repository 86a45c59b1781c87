#!/usr/bin/env python3
"""Writes generated/amphora.ply, a fluted vase on a base."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from mesh import lathe, smooth_curve, surface  # noqa: E402

BASE = [(0, 0), (0.46, 0), (0.46, 0), (0.46, 0.10), (0.46, 0.10), (0.30, 0.14), (0.17, 0.30)]
BODY = [(0.17, 0.30), (0.28, 0.42), (0.50, 0.80), (0.56, 1.20), (0.40, 1.58), (0.18, 1.78), (0.17, 1.95), (0.32, 2.14)]
LIP = [(0.32, 2.14), (0.34, 2.17), (0.30, 2.17), (0.14, 1.95), (0.10, 1.80), (0, 1.75)]
PATH = smooth_curve(BODY, 32)[0]


def body(u, v):
    """Turned like the rest, but with flutes that fade at both ends."""
    x = min(max(v, 0.0), 1.0) * (len(PATH) - 1)
    i = min(int(x), len(PATH) - 2)
    r, y = (a + (x - i) * (b - a) for a, b in zip(PATH[i], PATH[i + 1]))
    a = 2 * math.pi * u
    r *= 1 - 0.09 * abs(math.sin(10 * a)) * math.sin(math.pi * min(max(v, 0.0), 1.0)) ** 2
    return (r * math.cos(a), y, -r * math.sin(a))


vase = lathe(BASE)
vase.append(surface(body, 240, 96))
vase.append(lathe(LIP))
vase.write_ply(os.path.join(HERE, "generated", "amphora.ply"))
