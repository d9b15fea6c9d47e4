"""Damages files: any bytes, the words of a header, the chunks of a PNG picture, the elements of a DICOM file, the values of a JSON document."""

import json
import re
import struct
import zlib

# Where readers go wrong.
WORDS = ["0", "-1", "1", "2", "3", "255", "65535", "65536", "2147483647", "-2147483648", "4294967296", "18446744073709551615", "1e308", "-1e308", "1e-320",
         "nan", "inf", "1e9", "1e-9", "1000000", "", "x", "-", ".", "\x00", "\u2028", "../../etc/passwd", "/dev/zero", "a" * 5000, "[", "{", "%d", "%s%s%n"]
NUMBERS = [0, -1, 1, 2, 0.5, 1e-9, 1e9, 1e308, -1e308, 255, 65536, 2**31 - 1, -(2**31), 2**32, 2**53, 2**63, 2**64]


def bytes_changed(data, rng, others):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 4, 16))):
        at = rng.randrange(len(data) + 1)
        kind = rng.randrange(7)
        if kind == 0 and data:
            data[min(at, len(data) - 1)] ^= 1 << rng.randrange(8)
        elif kind == 1 and data:
            data[min(at, len(data) - 1)] = rng.randrange(256)
        elif kind == 2:
            del data[at : at + rng.choice((1, 2, 8, 100, 1000))]
        elif kind == 3:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.choice((1, 2, 8, 64))))
        elif kind == 4:
            data[at : at + 4] = struct.pack(rng.choice("<>") + "I", rng.choice((0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)))
        elif kind == 5:
            other = rng.choice(others)
            begin = rng.randrange(len(other) + 1)
            piece = other[begin : begin + rng.choice((4, 32, 256, 4096))]
            data[at : at + rng.choice((0, len(piece)))] = piece
        else:
            data[at : at + 64] = bytes([rng.choice((0, 0x20, 0xFF))]) * len(data[at : at + 64])
    return bytes(data)


def cut_short(data, rng, others):
    return data[: rng.randrange(len(data) + 1)]


def words_changed(data, rng, others):
    """Of a text, or of the header that a file begins with: other words, lines away, lines twice."""
    text = data.decode("latin-1")
    end = len(text)
    for mark in ("\n\n", "end_header\n", "LOCAL\n", "<AppendedData"):
        if mark in text:
            end = min(end, text.index(mark))
    head, rest = text[:end], text[end:]
    for _ in range(rng.choice((1, 1, 2, 3))):
        kind = rng.randrange(5)
        lines = head.split("\n")
        n = rng.randrange(len(lines))
        if kind == 0:
            del lines[n]
        elif kind == 1:
            lines[n:n] = [rng.choice(lines)] * rng.choice((1, 2, 1000))
        else:
            # First a line, then a word of it: the few lines of a header count as much as the many rows of a table.
            pieces = re.split(r"([\s=:,;()\"<>\[\]{}/]+)", lines[n])
            places = [k for k in range(0, len(pieces), 2) if pieces[k]]
            if places:
                other = re.split(r"[\s=:,;()\"<>\[\]{}]+", rng.choice(lines))
                pieces[rng.choice(places)] = rng.choice(other) if kind == 2 else rng.choice(WORDS)
                lines[n] = "".join(pieces)
        head = "\n".join(lines)
    return (head + rest).encode("utf-8" if "\u2028" in head else "latin-1", "replace")


def png_chunks(data):
    """(name, content) of each chunk, as far as they can be followed."""
    chunks, at = [], 8
    while at + 12 <= len(data):
        size, name = struct.unpack(">I4s", data[at : at + 8])
        chunks.append((name, data[at + 8 : at + 8 + size]))
        at += 12 + size
    return chunks


def png_of(chunks, rng, wrong=None):
    out = b"\x89PNG\r\n\x1a\n"
    for n, (name, content) in enumerate(chunks):
        size, check = len(content), zlib.crc32(name + content)
        if n == wrong:
            size, check = rng.choice(((size, check ^ 1), (rng.choice((0, 0x7FFFFFFF, 0xFFFFFFFF, size + 1)), check)))
        out += struct.pack(">I", size) + name + content + struct.pack(">I", check)
    return out


def png_changed(data, rng, others):
    """The sums are right again, so that a damaged picture reaches what reads it."""
    chunks = png_chunks(data)
    wrong = None
    for _ in range(rng.choice((1, 1, 2))):
        if not chunks:
            break
        n = rng.randrange(len(chunks))
        name, content = chunks[n]
        kind = rng.randrange(9)
        if kind == 0:
            del chunks[n]
        elif kind == 1:
            chunks.insert(rng.randrange(len(chunks) + 1), chunks[n])
        elif kind == 2:
            rng.shuffle(chunks)
        elif kind in (3, 4) and chunks[0][0] == b"IHDR" and len(chunks[0][1]) == 13:
            header = bytearray(chunks[0][1])
            if rng.randrange(2):
                struct.pack_into(">I", header, rng.choice((0, 4)), rng.choice((0, 1, 2, 7, 65536, 40000, 2**31 - 1, 2**32 - 1)))
            else:
                header[rng.randrange(8, 13)] = rng.choice((0, 1, 2, 3, 4, 6, 8, 16, 77, 255))
            chunks[0] = (b"IHDR", bytes(header))
        elif kind == 5:
            wrong = n
        elif kind == 6 and name == b"IDAT":
            try:
                raw = zlib.decompress(content)
            except zlib.error:
                continue
            raw = bytes_changed(raw, rng, [raw]) if rng.randrange(2) else raw[: rng.randrange(len(raw) + 1)] + b"\0" * rng.choice((0, 1, 10_000_000))
            chunks[n] = (name, zlib.compress(raw, 1))
        elif kind == 7:
            extra = rng.choice(((b"PLTE", b"\0" * 7), (b"tRNS", b"\0"), (b"gAMA", b"\0" * 4), (b"iCCP", b"a\0\0x"), (b"zTXt", b"a\0\0" + zlib.compress(b"a" * 10_000_000)),
                                (b"sBIT", b"\x63"), (b"XXXX", b""), (b"eXIf", b"II*\0\xff\xff\xff\xff"), (b"IEND", b"")))
            chunks.insert(rng.randrange(len(chunks) + 1), extra)
        else:
            chunks[n] = (name, bytes_changed(content, rng, [content]))
    return png_of(chunks, rng, wrong)


def dicom_elements(data):
    """(group, number, VR, value) of an explicit little-endian file, as far as they can be followed."""
    elements, at = [], 132
    while at + 8 <= len(data):
        group, number, vr = struct.unpack("<HH2s", data[at : at + 6])
        is_long = vr in (b"OB", b"OW", b"SQ", b"UN", b"UT", b"OF")
        if at + 12 > len(data):
            break
        size = struct.unpack("<I", data[at + 8 : at + 12])[0] if is_long else struct.unpack("<H", data[at + 6 : at + 8])[0]
        begin = at + (12 if is_long else 8)
        elements.append((group, number, vr, data[begin : begin + size]))
        at = begin + size
    return elements


def dicom_of(elements, wrong, rng):
    out = b"\0" * 128 + b"DICM"
    for n, (group, number, vr, value) in enumerate(elements):
        is_long = vr in (b"OB", b"OW", b"SQ", b"UN", b"UT", b"OF")
        size = len(value)
        if n == wrong:
            size = rng.choice((0, size + 2, 0xFFFF, 0xFFFFFFFF, 0x7FFFFFFE))
        out += struct.pack("<HH2s", group, number, vr) + (struct.pack("<HI", 0, size) if is_long else struct.pack("<H", min(size, 0xFFFF))) + value
    return out


SYNTAXES = ["1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2", "1.2.840.10008.1.2.1.99", "1.2.840.10008.1.2.4.50", "1.2.840.10008.1.2.4.57",
            "1.2.840.10008.1.2.4.70", "1.2.840.10008.1.2.4.80", "1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2.5", "1.2.3"]


def dicom_changed(data, rng, others):
    elements = dicom_elements(data)
    wrong = None
    for _ in range(rng.choice((1, 1, 2, 3))):
        if not elements:
            break
        n = rng.randrange(len(elements))
        group, number, vr, value = elements[n]
        kind = rng.randrange(9)
        if kind == 0:
            del elements[n]
        elif kind == 1:
            elements.insert(rng.randrange(len(elements) + 1), elements[n])
        elif kind == 2:
            wrong = n
        elif kind == 3:
            elements[n] = (group, number, rng.choice((b"OB", b"OW", b"SQ", b"UN", b"DS", b"US", b"UI", b"\0\0")), value)
        elif kind in (4, 5) and vr in (b"DS", b"IS", b"CS", b"UI"):
            parts = value.split(b"\\")
            parts[rng.randrange(len(parts))] = rng.choice(WORDS).encode()
            text = b"\\".join(parts)
            elements[n] = (group, number, vr, text + b" " * (len(text) % 2))
        elif kind in (4, 5) and vr == b"US":
            elements[n] = (group, number, vr, struct.pack("<H", rng.choice((0, 1, 2, 7, 8, 12, 16, 32, 255, 4096, 65535))))
        elif kind == 6:
            nested = b"\xfe\xff\x00\xe0\xff\xff\xff\xff" * rng.choice((1, 3, 2000))
            elements.insert(n, (8, 0x1140, b"SQ", nested))
        elif kind == 7:
            elements = [(g, e, v, rng.choice(SYNTAXES).encode() if (g, e) == (2, 0x10) else x) for g, e, v, x in elements]
        else:
            elements[n] = (group, number, vr, bytes_changed(value, rng, [value]) if value else b"\0\0")
    return dicom_of(elements, wrong, rng)


def places_in(value, path=()):
    """Of every value in a document."""
    found = [path]
    for key, item in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        found += places_in(item, path + (key,))
    return found


def deep(levels):
    value = []
    for _ in range(levels):
        value = [value]
    return value


def other_value(rng):
    return rng.choice((None, True, [], {}, "", "a", "\u2028", "x" * 10000, [1, 2], {"a": 1}, deep(200), [[0] * 4] * 4, rng.choice(NUMBERS), rng.choice(NUMBERS),
                       rng.choice(NUMBERS)))


def json_changed(data, rng, others):
    """A document of the same kind with other values, keys away, keys of another's; the case file is JSON, too."""
    try:
        document = json.loads(data)
    except ValueError:
        return words_changed(data, rng, others)
    for _ in range(rng.choice((1, 1, 2, 3))):
        places = [place for place in places_in(document) if place]
        if not places:
            break
        *outer, last = rng.choice(places)
        holder = document
        for key in outer:
            holder = holder[key]
        kind = rng.randrange(6)
        if kind == 0:
            del holder[last]
        elif kind == 1 and isinstance(holder, list):
            holder[last:last] = [holder[last]] * rng.choice((1, 2, 500))
        elif kind == 1:
            holder[rng.choice(("", "a", "schema", "\n", str(last).upper()))] = holder[last]
        elif kind == 2 and isinstance(holder[last], (int, float)) and not isinstance(holder[last], bool):
            holder[last] = holder[last] * rng.choice((-1, 0, 1e-3, 1e3, 1e300))
        else:
            holder[last] = other_value(rng)
    return json.dumps(document).encode()


def mutators_of(name):
    """What may damage a file of this name, the kinds that know its form first in number."""
    always = [bytes_changed, cut_short]
    suffix = name.rpartition(".")[2].lower()
    if suffix == "png":
        return [png_changed] * 4 + always
    if suffix == "dcm":
        return [dicom_changed] * 4 + always
    if suffix in ("json", "yaml"):
        return [json_changed] * 4 + [words_changed] + always
    return [words_changed] * 4 + always
