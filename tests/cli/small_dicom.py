"""A CT series small enough to be written by hand: 16 bit slices of a warm block in air, explicit little endian."""

import pathlib
import struct

ROWS = COLUMNS = 16
SPACING_MM = 2.0


def _element(group, number, vr, value):
    if isinstance(value, str):
        value = value.encode("ascii")
    if len(value) % 2:
        value += b"\0" if vr == "UI" else b" "
    head = struct.pack("<HH2s", group, number, vr.encode())
    if vr in ("OB", "OW"):
        return head + struct.pack("<HI", 0, len(value)) + value
    return head + struct.pack("<H", len(value)) + value


def slice_bytes(position, number):
    """One axial slice with its first voxel at `position` (LPS, mm): 40 HU in the middle, air around."""
    pixels = b"".join(
        struct.pack("<h", 40 if 4 <= row < 12 and 4 <= column < 12 else -1000) for row in range(ROWS) for column in range(COLUMNS)
    )
    uid = f"1.2.826.0.1.3680043.10.9999.{number + 1}"
    meta = (
        _element(2, 1, "OB", b"\0\1")
        + _element(2, 2, "UI", "1.2.840.10008.5.1.4.1.1.2")
        + _element(2, 3, "UI", uid)
        + _element(2, 0x10, "UI", "1.2.840.10008.1.2.1")
        + _element(2, 0x12, "UI", "1.2.826.0.1.3680043.10.9999")
    )
    short = lambda value: struct.pack("<H", value)
    data = (
        _element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2")
        + _element(8, 0x18, "UI", uid)
        + _element(8, 0x60, "CS", "CT")
        + _element(0x20, 0xD, "UI", "1.2.826.0.1.3680043.10.9999.100")
        + _element(0x20, 0xE, "UI", "1.2.826.0.1.3680043.10.9999.101")
        + _element(0x20, 0x13, "IS", str(number + 1))
        + _element(0x20, 0x32, "DS", "\\".join(f"{p:.4f}" for p in position))
        + _element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
        + _element(0x28, 2, "US", short(1))
        + _element(0x28, 4, "CS", "MONOCHROME2")
        + _element(0x28, 0x10, "US", short(ROWS))
        + _element(0x28, 0x11, "US", short(COLUMNS))
        + _element(0x28, 0x30, "DS", f"{SPACING_MM}\\{SPACING_MM}")
        + _element(0x28, 0x100, "US", short(16))
        + _element(0x28, 0x101, "US", short(16))
        + _element(0x28, 0x102, "US", short(15))
        + _element(0x28, 0x103, "US", short(1))
        + _element(0x28, 0x1052, "DS", "0")
        + _element(0x28, 0x1053, "DS", "1")
        + _element(0x7FE0, 0x10, "OW", pixels)
    )
    return b"\0" * 128 + b"DICM" + _element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + data


def write_series(folder, positions):
    """One file for each position of a slice's first voxel."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True)
    for number, position in enumerate(positions):
        (folder / f"IM{number:04}.dcm").write_bytes(slice_bytes(position, number))
    return folder


def regular(slices=12):
    return [(0.0, 0.0, SPACING_MM * n) for n in range(slices)]


def tilted(slices=12, shift_mm=0.6):
    """As a tilted gantry leaves them: each slice sideways of the one below."""
    return [(0.0, shift_mm * n, SPACING_MM * n) for n in range(slices)]


def uneven():
    """Six thin steps, then six thick ones."""
    return [(0.0, 0.0, 2.0 * n if n < 6 else 10.0 + 3.5 * (n - 5)) for n in range(12)]


def with_hole():
    return [position for n, position in enumerate(regular()) if n != 5]
