"""Draws small photographs and depth pictures with the standard library alone."""

import math
import struct
import zlib

TISSUE, GREEN, RED = (186, 112, 100), (30, 160, 60), (205, 20, 35)


def write_png(path, width, height, channels, bits, rows):
    """`rows`: bytes of each row, big endian where 16 bits."""
    color_type = {1: 0, 3: 2, 4: 6}[channels]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    data = b"".join(b"\0" + row for row in rows)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, color_type, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(data, 1))
        + chunk(b"IEND", b"")
    )
    return path


def mixed(a, b, share):
    return tuple(x + (y - x) * share for x, y in zip(a, b))


def painted_columns(v, width, center, rings):
    """The columns of row v that some ring may cover, in order; a pixel more on either side."""
    columns = set()
    for radius, line, _, _ in rings:
        outer, inner = (radius + side * (0.5 * line + 1.5) for side in (1, -1))
        dy = abs(v - center[1])
        if dy > outer:
            continue
        far = math.sqrt(outer * outer - dy * dy)
        near = math.sqrt(inner * inner - dy * dy) if inner > dy else 0.0
        columns.update(range(math.floor(center[0] - far), math.ceil(center[0] - near) + 1))
        columns.update(range(math.floor(center[0] + near), math.ceil(center[0] + far) + 1))
    return sorted(u for u in columns if 0 <= u < width)


def ring_photo(path, width=500, height=500, center=(250.0, 250.0), rings=(), channels=3, bits=8):
    """Tissue with painted circles: (radius_px, width_px, colour, opening_deg)."""

    def share_at(u, v):
        # Uneven light and a grain, the same at each run.
        return 1.0 - 0.2 * u / width + 0.01 * ((u * 7919 + v * 104729) % 7 - 3)

    def pixel(color):
        values = [min(255, max(0, round(c))) for c in color]
        if channels == 1:
            values = values[:1]
        elif channels == 4:
            values.append(255)
        return b"".join(struct.pack(">H", 257 * c) for c in values) if bits == 16 else bytes(values)

    # The grain repeats every seventh row, so bare tissue is drawn seven times; then only what lies near a ring.
    bare = [[pixel(tuple(c * share_at(u, v) for c in TISSUE)) for u in range(width)] for v in range(min(height, 7))]
    rows = []
    for v in range(height):
        row = list(bare[v % 7])
        for u in painted_columns(v, width, center, rings):
            dx, dy = u - center[0], v - center[1]
            r = math.hypot(dx, dy)
            share = share_at(u, v)
            color = tuple(c * share for c in TISSUE)
            for radius, line, ink, opening_deg in rings:
                cover = min(1.0, max(0.0, 0.5 + 0.5 * line - abs(r - radius)))
                if cover > 0.0 and abs(math.degrees(math.atan2(dy, dx))) >= 0.5 * opening_deg:
                    color = mixed(color, tuple(c * share for c in ink), cover)
            row[u] = pixel(color)
        rows.append(b"".join(row))
    return write_png(path, width, height, channels, bits, rows)


def depth_picture(path, width, height, counts_at):
    rows = [b"".join(struct.pack(">H", counts_at(u, v)) for u in range(width)) for v in range(height)]
    return write_png(path, width, height, 1, 16, rows)
