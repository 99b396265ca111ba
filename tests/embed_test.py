#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""examples/embed, built against an installed copy of a build and run: what a foreign renderer would do.

    tests/embed_test.py build/release

The wall shows the camera its dark side and throws a shadow of 2 x 2 metres; how many pixels that makes is known.
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"'{' '.join(str(word) for word in command)}' ended with status {done.returncode}\n"
                 f"{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def expected_pixels(width=320, height=240, yfov=0.9):
    """Lit and dark pixels of the example's scene by intersecting each pixel's ray, and how many lie on an edge."""
    length = math.hypot(5, 7)
    ahead, above = (-5 / length, -7 / length), (7 / length, -5 / length)  # the camera's axes: y and z; x is the world's
    tangent = math.tan(yfov / 2)

    def seen(column, row):
        x = (2 * (column + 0.5) / width - 1) * tangent * width / height
        y = (1 - 2 * (row + 0.5) / height) * tangent
        dy, dz = ahead[0] + y * above[0], ahead[1] + y * above[1]
        wall = -7 / dz if dz < 0 else -1
        if wall > 0 and abs(x * wall) <= 1 and 0 <= 5 + dy * wall <= 2:
            return "dark"
        floor = -5 / dy if dy < 0 else -1
        px, pz = x * floor, 7 + dz * floor
        if floor <= 0 or abs(px) > 4 or abs(pz) > 4:
            return "none"
        return "dark" if abs(px) < 1 and 0 < pz < 2 else "lit"

    picture = [[seen(column, row) for column in range(width)] for row in range(height)]
    edges = sum(picture[row][column] != picture[row][column + 1] or picture[row][column] != picture[row + 1][column]
                for row in range(height - 1) for column in range(width - 1))
    return sum(row.count("lit") for row in picture), sum(row.count("dark") for row in picture), edges


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

    environment = {key: value for key, value in os.environ.items() if key != "GNOMON_DATA"}
    said = run(folder / "build" / "embed", folder / "shadow.png", cwd=folder, env=environment)
    counts = re.search(r"(\d+) lit, (\d+) dark pixels", said)
    if not counts or (folder / "shadow.png").stat().st_size < 200:
        sys.exit(f"the example wrote no picture; it said: {said}")
    lit, dark = int(counts[1]), int(counts[2])
    expected_lit, expected_dark, edges = expected_pixels()
    if abs(lit - expected_lit) > edges or abs(dark - expected_dark) > edges:
        sys.exit(f"{lit} lit and {dark} dark pixels; the geometry makes {expected_lit} and {expected_dark}, "
                 f"and {edges} pixels lie on an edge")
    print(said.strip())


if __name__ == "__main__":
    main()
