"""How far two renderings of one scene are apart: difference.py VITRUM.png POVRAY.ppm

The PNG is 8 bits of sRGB, RGB or RGBA. The PPM is linear, 16 bits, and a whole number of times as large: each block of
it is averaged into one pixel. Both are compared as linear radiance. Python's standard library is enough.
"""

import array
import re
import struct
import sys
import zlib


def linear(code):
    """The inverse of the sRGB transfer function (IEC 61966-2-1), 8 bits."""
    v = code / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def read_png(path):
    """Width, height and rows of linear RGB."""
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is not a PNG file"
    position, packed, header = 8, b"", None
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position : position + 8])
        body = data[position + 8 : position + 8 + length]
        header = body if kind == b"IHDR" else header
        packed += body if kind == b"IDAT" else b""
        position += 12 + length
    width, height, bits, colour, _, _, interlaced = struct.unpack(">IIBBBBB", header)
    assert bits == 8 and colour in (2, 6) and not interlaced, f"{path}: expected 8-bit RGB or RGBA, not interlaced"
    step = 3 if colour == 2 else 4
    raw, table = zlib.decompress(packed), [linear(code) for code in range(256)]
    rows, before = [], bytearray(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        row = unfilter(raw[start], bytearray(raw[start + 1 : start + 1 + width * step]), before, step)
        rows.append([table[row[x * step + c]] for x in range(width) for c in range(3)])
        before = row
    return width, height, rows


def unfilter(kind, row, above, step):
    """Undoes the filter of one PNG row (PNG specification, section 9)."""
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        up = above[i]
        corner = above[i - step] if i >= step else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        elif kind == 4:
            p = left + up - corner
            guess = min((left, up, corner), key=lambda candidate: abs(p - candidate))
        else:
            guess = 0
        row[i] = (row[i] + guess) & 255
    return row


def read_ppm(path, width, height):
    """Rows of linear RGB, averaged down to width by height."""
    data = open(path, "rb").read()
    # POV-Ray writes several lines of comment between the fields.
    header = re.match(rb"P6\s+(?:#.*\n)*(\d+)\s+(?:#.*\n)*(\d+)\s+(?:#.*\n)*(\d+)\s", data)
    assert header, f"{path} is not a PPM file"
    wide, high, most = map(int, header.groups())
    assert most == 65535, f"{path}: the largest value is {most}, expected 65535"
    side = wide // width
    assert (wide, high) == (width * side, height * side), f"{path} is {wide}x{high}, no multiple of {width}x{height}"
    values = array.array("H", data[header.end() :])
    if sys.byteorder == "little":
        values.byteswap()
    rows, scale = [], 1 / (most * side * side)
    for y in range(height):
        block = [values[(y * side + j) * wide * 3 : (y * side + j + 1) * wide * 3] for j in range(side)]
        columns = [sum(column) for column in zip(*block)]
        rows.append(
            [scale * sum(columns[(x * side + i) * 3 + c] for i in range(side)) for x in range(width) for c in range(3)]
        )
    return rows


def main():
    width, height, ours = read_png(sys.argv[1])
    theirs = read_ppm(sys.argv[2], width, height)
    differences = sorted(abs(a - b) for row, other in zip(ours, theirs) for a, b in zip(row, other))
    count = len(differences)
    bias = sum(a - b for row, other in zip(ours, theirs) for a, b in zip(row, other)) / count
    print(f"mean absolute difference {sum(differences) / count:.5f}, median {differences[count // 2]:.5f}, "
          f"99 % below {differences[count * 99 // 100]:.4f}, largest {differences[-1]:.3f}; mean difference {bias:+.5f} (linear)")


if __name__ == "__main__":
    main()
