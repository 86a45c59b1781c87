#!/usr/bin/env python3
"""Writes the textures of the six balls to generated/. In all of them u runs around the ball, v from pole to pole."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from picture import cell, fractal, mix, smoothstep, write_hdr, write_png  # noqa: E402

WIDTH, HEIGHT = 256, 128
OUT = os.path.join(HERE, "generated")


def uv(x, y):
    return (x + 0.5) / WIDTH, (y + 0.5) / HEIGHT


def marble(x, y):
    """Veins: a wave whose phase the noise shifts."""
    u, v = uv(x, y)
    n = fractal(8 * u, 4 * v, 5, 8, 11)
    vein = abs(math.sin(math.pi * (6 * u + 3 * v + 5 * n))) ** 0.6
    base = mix((0.16, 0.30, 0.34), (0.93, 0.88, 0.78), smoothstep(0.1, 0.9, vein))
    return mix((0.80, 0.48, 0.20), base, smoothstep(0.02, 0.20, vein))


def bands(x, y, across):
    """Roughness along one direction: fine bands that swap with those of the other."""
    u, v = uv(x, y)
    wide = (math.floor(8 * u) + math.floor(5 * v)) % 2 == across
    return 0.45 if wide else 0.03


def dots(x, y):
    """Black and white: dots on a grid whose rows are shifted."""
    u, v = uv(x, y)
    row = math.floor(8 * v)
    a, b = 16 * u + 0.5 * (row % 2), 8 * v
    return 1.0 if math.hypot((a % 1) - 0.5, (b % 1) - 0.5) < 0.33 else 0.0


def exponent(x, y):
    """From a broad gloss at the pole to a sharp one, in steps."""
    _, v = uv(x, y)
    n = 4.0 * 2.2 ** math.floor(9 * v)
    return (n, n, n)


def tiles(x, y):
    """Small roughness on cells, large in the joints."""
    u, v = uv(x, y)
    border, which = cell(14 * u, 7 * v, 14, 5)
    own = 0.02 + 0.30 * ((which[0] * 7 + which[1] * 3) % 5) / 4
    return own if border > 0.09 else 0.9


def lace(x, y):
    """Transparency of the paper: holes of a rosette."""
    u, v = uv(x, y)
    a, b = (10 * u) % 1 - 0.5, (5 * v) % 1 - 0.5
    r, angle = math.hypot(a, b), math.atan2(b, a)
    petals = 0.33 * (0.72 + 0.28 * math.cos(6 * angle))
    return 1.0 if 0.10 < r < petals else 0.0


def paper_color(x, y):
    u, v = uv(x, y)
    wash = fractal(6 * u, 3 * v, 4, 6, 3)
    return mix((0.88, 0.36, 0.30), (0.96, 0.80, 0.46), smoothstep(0.3, 0.7, wash))


for name, color in (("marble", marble), ("paper", paper_color)):
    write_png(os.path.join(OUT, name + ".png"), WIDTH, HEIGHT, color)
for name, value in (("alpha_u", lambda x, y: bands(x, y, 0)), ("alpha_v", lambda x, y: bands(x, y, 1)),
                    ("dots", dots), ("tiles", tiles), ("lace", lace)):
    write_png(os.path.join(OUT, name + ".png"), WIDTH, HEIGHT, value, channels=1)
write_hdr(os.path.join(OUT, "exponent.hdr"), 8, HEIGHT, exponent)
