"""What the generators of scenes share: noise, and pictures and grids in files (PNG, EXR, Mitsuba's .vol)."""
import array
import math
import random
import struct
import zlib

from modelling import write_file


class Noise:
    """Value noise on a lattice of 64^3 random numbers, smooth and periodic; within [-1, 1]."""
    SIZE = 64

    def __init__(self, seed):
        rng = random.Random(seed)
        self.values = [rng.uniform(-1, 1) for _ in range(self.SIZE ** 3)]

    def at(self, x, y, z=0.0):
        i, j, k = math.floor(x), math.floor(y), math.floor(z)
        x, y, z = x - i, y - j, z - k
        x, y, z = x * x * (3 - 2 * x), y * y * (3 - 2 * y), z * z * (3 - 2 * z)
        n, mask = self.values, self.SIZE - 1
        i0, i1 = i & mask, i + 1 & mask
        j0, j1 = (j & mask) << 6, (j + 1 & mask) << 6
        k0, k1 = (k & mask) << 12, (k + 1 & mask) << 12
        a = n[k0 | j0 | i0] * (1 - x) + n[k0 | j0 | i1] * x
        b = n[k0 | j1 | i0] * (1 - x) + n[k0 | j1 | i1] * x
        c = n[k1 | j0 | i0] * (1 - x) + n[k1 | j0 | i1] * x
        d = n[k1 | j1 | i0] * (1 - x) + n[k1 | j1 | i1] * x
        return (a * (1 - y) + b * y) * (1 - z) + (c * (1 - y) + d * y) * z

    def fractal(self, x, y, z=0.0, octaves=4, gain=0.5):
        """A sum of octaves, about within [-1, 1]."""
        total, weight, scale = 0.0, 1.0, 0.0
        for k in range(octaves):
            total += weight * self.at(x + 17 * k, y + 29 * k, z + 41 * k)
            scale += weight
            x, y, z, weight = 2 * x, 2 * y, 2 * z, weight * gain
        return total / scale


def mix(a, b, t):
    """From colour (or number) a to b, t is clamped to [0, 1]."""
    t = min(max(t, 0.0), 1.0)
    if isinstance(a, (int, float)):
        return a + (b - a) * t
    return tuple(p + (q - p) * t for p, q in zip(a, b))


def step(low, high, x):
    """0 below low, 1 above high, smooth between."""
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def write_png(path, width, height, color):
    """color(u, v) is sRGB-encoded, grey (a number) or a triple within [0, 1]; v = 0 is the top row."""
    rows, channels = bytearray(), 1
    for j in range(height):
        rows.append(0)
        for i in range(width):
            value = color((i + 0.5) / width, (j + 0.5) / height)
            if isinstance(value, tuple):
                channels = 3
                rows.extend([min(max(int(255 * c + 0.5), 0), 255) for c in value])
            else:
                rows.append(min(max(int(255 * value + 0.5), 0), 255))

    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))

    kind = 2 if channels == 3 else 0
    write_file(path, b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)),
               chunk(b"IDAT", zlib.compress(bytes(rows), 9)), chunk(b"IEND", b""))


def write_exr(path, width, height, color):
    """color(u, v) is a linear triple; v = 0 is the top row. Scanlines of float32, not compressed."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(name + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", channels)
    header += attribute(b"compression", b"compression", b"\0")
    header += attribute(b"dataWindow", b"box2i", box) + attribute(b"displayWindow", b"box2i", box)
    header += attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float",
                                                                       struct.pack("<f", 1))
    header += attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
    header += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    first, size = len(header) + 8 * height, 8 + 12 * width
    offsets = struct.pack(f"<{height}Q", *(first + size * j for j in range(height)))
    lines = bytearray()
    for j in range(height):
        row = [color((i + 0.5) / width, (j + 0.5) / height) for i in range(width)]
        lines += struct.pack("<ii", j, 12 * width)
        for channel in (2, 1, 0):
            lines += struct.pack(f"<{width}f", *(c[channel] for c in row))
    write_file(path, header, offsets, lines)


def write_vol(path, nx, ny, nz, density):
    """density(x, y, z) at the middle of each voxel of the unit cube; Mitsuba's grid, version 3, float32."""
    values = array.array("f", (density((i + 0.5) / nx, (j + 0.5) / ny, (k + 0.5) / nz)
                               for k in range(nz) for j in range(ny) for i in range(nx)))
    header = b"VOL\x03" + struct.pack("<5i6f", 1, nx, ny, nz, 1, 0, 0, 0, 1, 1, 1)
    write_file(path, header, struct.pack(f"<{len(values)}f", *values))
