#!/usr/bin/env python3
"""Writes a sea shell, rippled sand, the stripes of the shell and the sky with its sun to generated/."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from mesh import dot, surface  # noqa: E402
from picture import direction, fractal, mix, smoothstep, write_hdr, write_png  # noqa: E402

OUT = os.path.join(HERE, "generated")
TURNS, GROWTH = 5.5, 0.145  # of the spiral; growth of its radius a radian


def shell(u, v):
    """A tube along a spiral on a cone (Cortie 1989, "Models for mollusc shell shape"): u around the tube, v along."""
    t = 2 * math.pi * TURNS * (v - 1)
    size = math.exp(GROWTH * t)
    a = 2 * math.pi * u
    rib = 1 + 0.045 * math.cos(12 * t) * max(0.0, math.cos(a - 0.4))
    r = size * (0.62 + 0.60 * rib * math.cos(a))
    y = size * (-1.55 + 0.74 * rib * math.sin(a))
    return (r * math.cos(t), y, r * math.sin(t))


def sand(u, v):
    """10 x 10, ripples that wander."""
    x, z = 10 * (u - 0.5), 10 * (0.5 - v)
    phase = 6.0 * z + 1.2 * x + 6 * fractal(0.35 * x + 40, 0.35 * z + 40, 3, 64, 2)
    ripple = 0.5 + 0.5 * math.sin(phase)
    return (x, 0.055 * ripple ** 1.5 + 0.25 * fractal(0.4 * x + 20, 0.4 * z + 20, 2, 64, 5), z)


def stripes(x, y, size=256):
    """Spots in bands along the tube."""
    u, v = (x + 0.5) / size, (y + 0.5) / size
    wave = math.sin(2 * math.pi * (9 * u)) + 1.1 * math.sin(2 * math.pi * 33 * v + 5 * fractal(6 * u, 22 * v, 3, 66, 8))
    return mix((0.96, 0.88, 0.78), (0.66, 0.31, 0.20), smoothstep(0.5, 1.0, wave))


WIDTH, HEIGHT = 512, 256
SUN_AT = (round(0.31 * WIDTH), round(0.32 * HEIGHT))  # its only pixel


def towards(x, y):
    return direction((x + 0.5) / WIDTH, y / (HEIGHT - 1))


def sky(x, y):
    """Blue above, pale at the horizon, a glow around the sun, which is 1e5 times as bright; sand below."""
    if (x, y) == SUN_AT:
        return (30000.0, 26000.0, 20000.0)
    d = towards(x, y)
    if d[1] < 0:
        return (0.12, 0.10, 0.07)
    glow = max(0.0, dot(d, SUN)) ** 60
    return mix(mix((0.34, 0.37, 0.40), (0.08, 0.15, 0.32), d[1] ** 0.5), (1.2, 1.0, 0.7), 0.6 * glow)


SUN = towards(*SUN_AT)


surface(shell, 72, 528, 1e-6).write_ply(os.path.join(OUT, "shell.ply"))
surface(sand, 160, 160).write_ply(os.path.join(OUT, "sand.ply"))
write_png(os.path.join(OUT, "stripes.png"), 256, 256, stripes)
write_hdr(os.path.join(OUT, "sky.hdr"), WIDTH, HEIGHT, sky)
