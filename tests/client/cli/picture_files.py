# SPDX-License-Identifier: Apache-2.0
"""Reads the pictures that the client writes, without its libraries."""
import struct
import zlib


class PictureReader:
    """For a unittest.TestCase that has path(name)."""

    def read_png(self, name):
        """Rows of grey values or of triples, of a PNG file of 8 bits."""
        with open(self.path(name), "rb") as file:
            data = file.read()
        at, packed = 8, b""
        while at < len(data):
            size, kind = struct.unpack_from(">I4s", data, at)
            chunk = data[at + 8:at + 8 + size]
            if kind == b"IHDR":
                width, height, bits, colour = struct.unpack_from(">IIBB", chunk)
                self.assertEqual(bits, 8)
            packed += chunk if kind == b"IDAT" else b""
            at += 12 + size
        channels = {0: 1, 2: 3}[colour]
        raw, above, rows = zlib.decompress(packed), bytes(width * channels), []
        for y in range(height):
            kind, *line = raw[y * (width * channels + 1):(y + 1) * (width * channels + 1)]
            for x in range(len(line)):
                a = line[x - channels] if x >= channels else 0
                b, c = above[x], above[x - channels] if x >= channels else 0
                paeth = min((a, b, c), key=lambda v: abs(a + b - c - v))
                line[x] = line[x] + (0, a, b, (a + b) // 2, paeth)[kind] & 255
            above = line
            rows.append([tuple(line[x:x + channels]) for x in range(0, len(line), channels)])
        return rows

    def read_exr(self, data):
        """The attributes of each part of a multi-part OpenEXR file, and its pixels: one row of one channel of floats."""
        parts, at = [], 8
        def text():
            nonlocal at
            end = data.index(b"\0", at)
            piece, at = data[at:end].decode(), end + 1
            return piece
        while data[at]:
            part = {}
            while name := text():
                text()  # The type.
                size = struct.unpack_from("<i", data, at)[0]
                part[name] = data[at + 4:at + 4 + size]
                at += 4 + size
            parts.append(part)
        rows = []
        for number, part in enumerate(parts):
            left, _, right, _ = struct.unpack("<4i", part["dataWindow"])
            chunk = struct.unpack_from("<Q", data, at + 1 + 8 * number)[0]  # Each part has one chunk.
            owner, _, size = struct.unpack_from("<iii", data, chunk)
            self.assertEqual(owner, number)
            packed, width = data[chunk + 12:chunk + 12 + size], right - left + 1
            if size < 4 * width:  # Else it is stored as it is.
                deltas = zlib.decompress(packed)
                halves = [sum(deltas[:i + 1]) - 128 * i & 255 for i in range(len(deltas))]
                middle = (len(halves) + 1) // 2
                packed = bytes(halves[i // 2 + (middle if i % 2 else 0)] for i in range(len(halves)))
            rows.append(struct.unpack(f"<{width}f", packed))
        return parts, rows
