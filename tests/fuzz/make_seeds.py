#!/usr/bin/env python3
"""Writes the small files in seeds/hdr and seeds/pfm that the fuzzers start from.

One for each way that the decoders can take: codings, orientations, header lines, byte orders.
"""
import struct
from pathlib import Path

SEEDS = Path(__file__).parent / "seeds"


def write(name, data):
    path = SEEDS / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def hdr(resolution, data, lines=b"FORMAT=32-bit_rle_rgbe\n", magic=b"#?RADIANCE\n"):
    return magic + lines + b"\n" + resolution + b"\n" + data


def runs(width, planes):
    return bytes([2, 2, width >> 8, width & 255]) + b"".join(planes)


run_and_copy = bytes([128 + 5, 200, 3, 1, 2, 3])  # 8 texels: five alike, three not
scanline = runs(8, [run_and_copy] * 3 + [bytes([128 + 8, 129])])
flat = bytes([200, 100, 50, 129])
repeat = bytes([1, 1, 1])

write("hdr/runs.hdr", hdr(b"-Y 2 +X 8", scanline * 2))
write("hdr/flat_narrow.hdr", hdr(b"-Y 2 +X 3", flat * 6))
write("hdr/flat_wide.hdr", hdr(b"-Y 1 +X 9", flat * 9))
write("hdr/repeats.hdr", hdr(b"-Y 1 +X 300", flat + repeat + b"\x2b" + repeat + b"\x01"))
write("hdr/columns.hdr", hdr(b"+X 2 -Y 8", scanline * 2))
write("hdr/reversed.hdr", hdr(b"+Y 2 -X 8", scanline * 2))
write("hdr/exposure.hdr", hdr(b"-Y 1 +X 1", flat, b"EXPOSURE=2\nEXPOSURE=0.5\nCOLORCORR=1 2 3\n"))
write("hdr/xyz.hdr", hdr(b"-Y 1 +X 1", flat, b"# comment\nFORMAT=32-bit_rle_xyze\nVIEW= -vtv\n", b"#?RGBE\n"))

for name, header, order, count in [
    ("colour", b"PF\n2 2\n-1.0\n", "<", 12),
    ("grey", b"Pf\n3 2\n-1.0\n", "<", 6),
    ("big_endian", b"PF\n1 1\n1.0\n", ">", 3),
    ("one_line", b"Pf 1 1 -2.5\n", "<", 1),
]:
    write(f"pfm/{name}.pfm", header + struct.pack(f"{order}{count}f", *(i / 4 for i in range(count))))
