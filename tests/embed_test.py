#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""examples/embed, built against an installed copy of a build and run: what a foreign renderer would do.

    tests/embed_test.py build/release

The wall shows the camera its dark side and throws a shadow of 2 x 2 metres: which pixels are lit is known one by one, but for
those on an edge. A result that is dropped does not compile.
"""

import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"'{' '.join(str(word) for word in command)}' ended with status {done.returncode}\n"
                 f"{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def expected_picture(width=320, height=240, yfov=0.9):
    """What the example's scene shows by intersecting each pixel's ray: "lit", "dark" (or nothing there, which has no light
    either), or None where an edge of wall, floor or shadow is so near that the map's texels and the rasterizer decide."""
    length = math.hypot(5, 7)
    ahead, above = (-5 / length, -7 / length), (7 / length, -5 / length)  # the camera's axes: y and z; x is the world's
    tangent = math.tan(yfov / 2)
    # The map's 2048 texels span the eight by eight metres of floor, seen at 45 degrees, and the wall: below 8 mm each. The
    # kernel reaches two and the normal bias a quarter of one to each side.
    reach = 0.02

    def wall_at(x, y):
        return abs(x) <= 1 and 0 <= y <= 2

    def floor_at(x, z):
        if abs(x) > 4 or abs(z) > 4:
            return "dark"
        return "dark" if abs(x) < 1 and 0 < z < 2 else "lit"

    def seen(column, row):
        x = (2 * (column + 0.5) / width - 1) * tangent * width / height
        y = (1 - 2 * (row + 0.5) / height) * tangent
        dy, dz = ahead[0] + y * above[0], ahead[1] + y * above[1]
        around = [(-1, -1), (1, -1), (-1, 1), (1, 1)]
        wall = -7 / dz if dz < 0 else -1
        hits = {wall > 0 and wall_at(x * wall + i * 1e-3, 5 + dy * wall + k * 1e-3) for i, k in around}
        if hits == {True}:
            return "dark"
        floor = -5 / dy if dy < 0 else -1
        kinds = {floor_at(x * floor + i * reach, 7 + dz * floor + k * reach) if floor > 0 else "dark" for i, k in around}
        return kinds.pop() if hits == {False} and len(kinds) == 1 else None

    return [[seen(column, row) for column in range(width)] for row in range(height)]


def read_png(path):
    """Rows of the first channel of an 8-bit PNG, 0 to 255."""
    data = path.read_bytes()
    packed, at = b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[colour]
    if depth != 8:
        sys.exit(f"{path} has {depth} bits a channel; 8 are expected")
    raw, stride, above, rows = zlib.decompress(packed), width * channels, bytes(width * channels), []
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = line[i - channels] if i >= channels else 0
            up, corner = above[i], above[i - channels] if i >= channels else 0
            paeth = min((abs(up - corner), 0, left), (abs(left - corner), 1, up), (abs(left + up - 2 * corner), 2, corner))[2]
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        above = bytes(line)
        rows.append(line[::channels])
    return rows


def compare(picture, expected):
    """Fails unless every pixel that an edge does not decide is what the geometry says; returns how many those are."""
    wrong, decided = [], 0
    for y, row in enumerate(expected):
        for x, kind in enumerate(row):
            if kind is not None:
                decided += 1
                if picture[y][x] != (255 if kind == "lit" else 0):
                    wrong.append(f"({x}, {y}) is {picture[y][x]} and should be {kind}")
    if wrong:
        sys.exit(f"{len(wrong)} of {decided} pixels are wrong: {'; '.join(wrong[:5])}")
    return decided


def refuses_dropped_results(prefix):
    """A call whose result is dropped must be an error for a compiler that is asked to make it one; the same call kept must not."""
    for use, compiles in (("const auto kept = session.load_scene(\"stack\"); (void)kept.ok();", True),
                          ("session.load_scene(\"stack\");", False)):
        source = "#include \"shadow/embed/host.h\"\nvoid use(gn::host::Session& session) { " + use + " }\n"
        includes = [f"-I{folder}" for folder in (prefix / "include" / "gnomon", prefix / "include")]
        done = subprocess.run(["g++", "-std=c++20", "-fsyntax-only", "-Werror=unused-result", *includes, "-x", "c++", "-"],
                              input=source, capture_output=True, text=True, check=False)
        if (done.returncode == 0) != compiles or (not compiles and "nodiscard" not in done.stderr):
            sys.exit(f"'{use}' {'does not compile' if compiles else 'compiles'}: {done.stderr[:1000]}")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    folder = build / "embed"
    shutil.rmtree(folder / "prefix", ignore_errors=True)
    run("cmake", "--install", build, "--prefix", folder / "prefix")

    # Build far from the source tree's includes: only the installed ones can be found.
    source = folder / "source"
    shutil.rmtree(source, ignore_errors=True)
    shutil.copytree(ROOT / "examples" / "embed", source)
    run("cmake", "-G", "Ninja", "-S", source, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}",
        "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", folder / "build")

    refuses_dropped_results(folder / "prefix")
    environment = {key: value for key, value in os.environ.items() if key != "GNOMON_DATA"}
    said = run(folder / "build" / "embed", folder / "shadow.png", cwd=folder, env=environment)
    if not (folder / "shadow.png").exists():
        sys.exit(f"the example wrote no picture; it said: {said}")
    expected = expected_picture()
    decided = compare(read_png(folder / "shadow.png"), expected)
    # Edges are lines: the floor's outline, the wall's and the shadow's are some 1500 pixels long.
    if decided < 0.95 * sum(len(row) for row in expected):
        sys.exit(f"only {decided} pixels lie off the edges; the test has nothing to compare")
    print(f"{said.strip()}; {decided} compared one by one")


if __name__ == "__main__":
    main()
