#!/usr/bin/env python3
"""Writes generated/window.hdr: the radiance of a stained-glass window, a rose in a lancet."""
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
from picture import cell, hash01, smoothstep, write_hdr  # noqa: E402

WIDTH, HEIGHT = 128, 224
RED, BLUE, GOLD, GREEN, PALE = (17, 0.3, 0.2), (0.3, 1.5, 22), (20, 10, 0.8), (0.4, 14, 1.6), (7, 6.6, 5.4)


def window(x, y):
    """The lead between the panes is black; each pane is a little brighter or darker than the next."""
    u, v = (x + 0.5) / WIDTH, (y + 0.5) / WIDTH  # v runs downwards, to 1.75
    arch = 1 - max(math.hypot(u - 0.04, v - 0.98), math.hypot(u - 0.96, v - 0.98)) / 0.93 if v < 0.98 else \
        1 - abs(u - 0.5) / 0.48
    if arch < 0.0 or v > 1.71:  # clear diamonds around
        a, b = 12 * (u + v), 12 * (u - v)
        lead = min(0.5 - abs(c % 1 - 0.5) for c in (a, b)) / 17
        light = 0.25 * smoothstep(0.004, 0.012, min(lead, abs(arch) * 0.4))
        return tuple(light * (0.6 + 0.6 * hash01(math.floor(a), math.floor(b))) * c for c in PALE)
    lead, color, shade = rose(u - 0.5, v - 0.62)
    if lead is None:
        lead, which = cell(8 * u, 8 * v, 16, 4)
        lead, shade = lead / 8, hash01(*which, 7)
        color = (BLUE, PALE, BLUE, GOLD, GREEN, RED)[int(6 * hash01(*which, 8))]
    border = min(lead, 0.4 * arch)
    if 0.05 < arch < 0.13:
        color, border = (GOLD, RED)[int(24 * v) % 2], min(0.4 * (arch - 0.05), 0.4 * (0.13 - arch))
    light = smoothstep(0.004, 0.012, border) * (0.6 + 0.6 * shade)
    return tuple(light * c for c in color)


def rose(a, b):
    """Petals around a disk: distance to the lead, colour, shade; None outside."""
    r, turn = math.hypot(a, b), math.atan2(b, a) / (2 * math.pi)
    if r > 0.33:
        return None, None, None
    if r < 0.07:
        return 0.07 - r, GOLD, 0.8
    petals = 8 if r < 0.20 else 16
    k = petals * turn + 0.5
    across = 2 * math.pi * r / petals * (0.5 - abs(k % 1 - 0.5))
    along = min(r - 0.07, 0.20 - r) if r < 0.20 else min(r - 0.20, 0.33 - r)
    color = (RED, PALE)[math.floor(k) % 2] if r < 0.20 else (GOLD, BLUE, RED, BLUE)[math.floor(k) % 4]
    return min(across, along), color, hash01(math.floor(k), petals)


write_hdr(os.path.join(HERE, "generated", "window.hdr"), WIDTH, HEIGHT, window)
