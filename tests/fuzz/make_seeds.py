#!/usr/bin/env python3
"""Writes the small files in seeds that the fuzzers start from.

One for each way that the decoders can take: codings, orientations, header lines, byte orders.
Those of OpenEXR files are not made here: its own library wrote them, 9 x 5 texels by each method,
in lines and in tiles, and one each of levels, windows, environments, layers and parts.
"""
import math
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


def dds(dxgi, texel_bytes, faces, levels, code=b"DX10"):
    size = 1 << (levels - 1)
    caps2 = 0xFE00 if faces == 6 else 0
    header = struct.pack("<4s7I44x", b"DDS ", 124, 0x2100F, size, size, size * texel_bytes, 0, levels)
    header += struct.pack("<II4s20x", 32, 4, code) + struct.pack("<5I", 0x401008, caps2, 0, 0, 0)
    if code == b"DX10":
        header += struct.pack("<5I", dxgi, 3, 4 if faces == 6 else 0, 1, 0)
    texels = faces * sum(4 ** level for level in range(levels))
    return header + bytes(i * 7 & 63 for i in range(texels * texel_bytes))


write("dds/half_cube.dds", dds(10, 8, 6, 2))
write("dds/float.dds", dds(2, 16, 1, 2))
write("dds/float_rgb.dds", dds(6, 12, 1, 1))
write("dds/r11g11b10.dds", dds(26, 4, 6, 1))
write("dds/rgb9e5.dds", dds(67, 4, 1, 3))
write("dds/srgb.dds", dds(29, 4, 1, 1))
write("dds/legacy_cube.dds", dds(0, 8, 6, 2, struct.pack("<I", 113)))


def zstandard(data):  # one frame of one stored block
    return struct.pack("<IBB", 0xFD2FB528, 0x20, len(data)) + struct.pack("<I", 1 | len(data) << 3)[:3] + data


def ktx2(vk_format, type_size, texel_bytes, faces, levels, pack=None, orientation=b"rd"):
    size = 1 << (levels - 1)
    descriptor = struct.pack("<IIHHBBBB4x8B", 28, 0, 2, 24, 1, 1, 1, 0, texel_bytes, *[0] * 7)
    pair = b"KTXorientation\0" + orientation + b"\0"
    keys = struct.pack("<I", len(pair)) + pair
    keys += bytes(-len(keys) % 4)
    offset = 80 + 24 * levels
    header = bytes.fromhex("AB4B5458203230BB0D0A1A0A")
    header += struct.pack("<9I", vk_format, type_size, size, size, 0, 0, faces, levels, 2 if pack else 0)
    header += struct.pack("<4IQQ", offset, 28, offset + 28, len(keys), 0, 0)
    body, index = descriptor + keys, []
    for level in range(levels):  # smallest first
        data = bytes(i * 7 & 63 for i in range(faces * texel_bytes * 4**level))
        stored = pack(data) if pack else data
        if not pack:
            body += bytes(-(offset + len(body)) % math.lcm(texel_bytes, 4))
        index.insert(0, struct.pack("<3Q", offset + len(body), len(stored), len(data)))
        body += stored
    return header + b"".join(index) + body


write("ktx2/half_cube.ktx2", ktx2(97, 2, 8, 6, 2))
write("ktx2/float.ktx2", ktx2(109, 4, 16, 1, 2))
write("ktx2/half_rgb_upward.ktx2", ktx2(90, 2, 6, 1, 2, orientation=b"ru"))
write("ktx2/rgb9e5_zstandard.ktx2", ktx2(123, 4, 4, 6, 2, zstandard))
write("ktx2/b10g11r11.ktx2", ktx2(122, 4, 4, 1, 3))
write("ktx2/srgb.ktx2", ktx2(43, 1, 4, 1, 1))
