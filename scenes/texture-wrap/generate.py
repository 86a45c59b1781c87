#!/usr/bin/env python3
"""Writes generated/heron.png: a picture that no mirror leaves as it is, and with borders that differ, so that every wrap shows."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from picture import mix, smoothstep, write_png  # noqa: E402

SIZE = 64
SKY, DUSK, SUN, WATER, BIRD, BEAK = ((0.98, 0.80, 0.55), (0.88, 0.45, 0.42), (1.0, 0.95, 0.75), (0.20, 0.42, 0.52),
                                     (0.12, 0.16, 0.24), (0.95, 0.55, 0.15))


def stroke(p, points, width):
    """Cover in [0, 1] of a line through the points, `width` to each side."""
    nearest = 9.0
    for (ax, ay), (bx, by) in zip(points, points[1:]):
        dx, dy = bx - ax, by - ay
        t = min(1.0, max(0.0, ((p[0] - ax) * dx + (p[1] - ay) * dy) / (dx * dx + dy * dy)))
        nearest = min(nearest, math.hypot(p[0] - ax - t * dx, p[1] - ay - t * dy))
    return 1 - smoothstep(width - 0.6 / SIZE, width + 0.6 / SIZE, nearest)


def heron(x, y):
    p = ((x + 0.5) / SIZE, (y + 0.5) / SIZE)
    color = mix(SKY, DUSK, smoothstep(0.1, 0.75, p[1]))
    sun = math.hypot(p[0] - 0.26, p[1] - 0.34)
    color = mix(SUN, color, smoothstep(0.125, 0.145, sun))
    if p[1] > 0.76:
        ripple = 0.5 + 0.5 * math.sin(60 * p[1] + 3 * math.sin(17 * p[0]))
        color = mix(WATER, mix(WATER, SKY, 0.45), ripple ** 3)
    neck = [(0.66, 0.50), (0.58, 0.42), (0.62, 0.34), (0.68, 0.27), (0.66, 0.21), (0.60, 0.20)]
    for points, width in ((neck, 0.024), ([(0.64, 0.52), (0.74, 0.54), (0.86, 0.62)], 0.066), ([(0.80, 0.58), (0.93, 0.68)], 0.03),
                          ([(0.72, 0.58), (0.70, 0.72), (0.72, 0.88)], 0.011), ([(0.74, 0.58), (0.76, 0.70), (0.70, 0.74)], 0.011),
                          ([(0.61, 0.205), (0.64, 0.205)], 0.036), ([(0.66, 0.19), (0.75, 0.15)], 0.010)):
        color = mix(color, BIRD, stroke(p, points, width))
    color = mix(color, BEAK, stroke(p, [(0.575, 0.205), (0.44, 0.235)], 0.012))
    return color


write_png(os.path.join(HERE, "generated", "heron.png"), SIZE, SIZE, heron)
