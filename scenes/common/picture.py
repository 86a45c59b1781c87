"""Pictures from formulae: 8-bit PNG, and Radiance HDR for what is brighter than white; noise to make them of."""
import math
import struct
import zlib

from mesh import write_file


def write_png(path, width, height, color, channels=3):
    """color(x, y) of each pixel, row 0 on top: `channels` numbers in [0, 1] as they are stored (sRGB for colours)."""
    rows = bytearray()
    for y in range(height):
        rows.append(0)  # no filter
        for x in range(width):
            value = color(x, y)
            for c in value if channels > 1 else (value,):
                rows.append(min(255, max(0, round(255 * c))))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 0 if channels == 1 else 2, 0, 0, 0)
    write_file(path, b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9))
               + chunk(b"IEND", b""))


def write_hdr(path, width, height, color):
    """color(x, y) of each pixel, row 0 on top: linear r, g, b >= 0 (Ward 1991, "Real Pixels")."""
    content = bytearray(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
    for y in range(height):
        row = [rgbe(*color(x, y)) for x in range(width)]
        content += bytes((2, 2, width >> 8, width & 255))
        for c in range(4):  # channel by channel, in runs of at most 128 literal bytes
            for start in range(0, width, 128):
                run = bytes(pixel[c] for pixel in row[start:start + 128])
                content += bytes((len(run),)) + run
    write_file(path, bytes(content))


def rgbe(r, g, b):
    most = max(r, g, b)
    if most < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(most)
    scale = mantissa * 256 / most
    return (int(r * scale), int(g * scale), int(b * scale), exponent + 128)


def direction(u, v):
    """Where pixel (u, v) in [0, 1]^2 of an environment map looks: v = 0 is up, u = 0.5 is +z."""
    phi, theta = 2 * math.pi * u, math.pi * v
    return (math.sin(phi) * math.sin(theta), math.cos(theta), -math.cos(phi) * math.sin(theta))


def to_srgb(linear):
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def mix(a, b, t):
    return tuple((1 - t) * x + t * y for x, y in zip(a, b))


def smoothstep(low, high, x):
    t = min(1.0, max(0.0, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def hash01(*numbers):
    """A number in [0, 1) for each tuple of integers."""
    h = 2166136261
    for n in numbers:
        h = ((h ^ (n & 0xffffffff)) * 16777619) & 0xffffffff
        h ^= h >> 15
    h = (h * 2246822519) & 0xffffffff
    return ((h ^ (h >> 13)) & 0xffffff) / 16777216


def noise(x, y, period=256, seed=0):
    """Smooth noise in [0, 1] with one value a unit square; repeats after `period` units."""
    i, j = math.floor(x), math.floor(y)
    fx, fy = x - i, y - j
    fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
    corner = lambda a, b: hash01((i + a) % period, (j + b) % period, seed)
    return ((1 - fy) * ((1 - fx) * corner(0, 0) + fx * corner(1, 0)) +
            fy * ((1 - fx) * corner(0, 1) + fx * corner(1, 1)))


def fractal(x, y, octaves=4, period=256, seed=0):
    """Sum of noises of doubling frequency and halving height, in [0, 1]."""
    total, weight, scale = 0.0, 0.0, 1
    for k in range(octaves):
        total += noise(x * scale, y * scale, period * scale, seed + k) / scale
        weight += 1 / scale
        scale *= 2
    return total / weight


def cell(x, y, period, seed=0):
    """Voronoi cells, a point a unit square: distance to the border between the two nearest points, and the cell."""
    near = []
    i, j = math.floor(x), math.floor(y)
    for b in range(j - 1, j + 2):
        for a in range(i - 1, i + 2):
            wrapped = (a % period, b % period)
            p = (a + 0.1 + 0.8 * hash01(*wrapped, seed), b + 0.1 + 0.8 * hash01(*wrapped, seed + 1))
            near.append((math.dist((x, y), p), p, wrapped))
    near.sort()
    (_, p, wrapped), (_, q, _) = near[:2]
    middle = ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
    length = math.dist(p, q)
    border = ((middle[0] - x) * (q[0] - p[0]) + (middle[1] - y) * (q[1] - p[1])) / length
    return border, wrapped
