# SPDX-License-Identifier: MIT
"""What the pictures of examples/embed must show, pixel by pixel, from the geometry alone; and reading them.

An expected picture is a list of rows of "lit", "dark", or None where edges, texels or what moves decide.
"""

import math
import struct
import sys
import zlib


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


def read_pgm(path):
    """Rows of an 8-bit grey picture whose head is one line."""
    head, _, pixels = path.read_bytes().partition(b"\n")
    width, height = (int(word) for word in head.split()[1:3])
    return [pixels[y * width:(y + 1) * width] for y in range(height)]


def compare(name, picture, expected, least):
    """Fails unless every pixel that is decided is what the geometry says, and at least so many of each kind are."""
    wrong, counts = [], {"lit": 0, "dark": 0}
    for y, row in enumerate(expected):
        for x, kind in enumerate(row):
            if kind is not None:
                counts[kind] += 1
                if picture[y][x] != (255 if kind == "lit" else 0):
                    wrong.append(f"({x}, {y}) is {picture[y][x]} and should be {kind}")
    if wrong:
        sys.exit(f"{name}: {len(wrong)} of {sum(counts.values())} pixels are wrong: {'; '.join(wrong[:5])}")
    if min(counts.values()) < least:
        sys.exit(f"{name}: only {counts} pixels lie off what is undecided; the test has nothing to compare")
    return sum(counts.values())


def wall_picture(rim, wall_x=0, width=320, height=240, yfov=0.9):
    """A floor of 8 x 8 metres and a wall of 2 x 2 under a sun (examples/embed/offline.cpp), its middle at wall_x. Nothing has
    no light either.
    Where `rim` is set, pixels beside another surface are not decided: a normal told from depth there may be the other's."""
    length = math.hypot(5, 7)
    ahead, above = (-5 / length, -7 / length), (7 / length, -5 / length)  # the camera's axes: y and z; x is the world's
    tangent = math.tan(yfov / 2)
    # The map's 2048 texels span the eight by eight metres of floor, seen at 45 degrees, and the wall: below 8 mm each. The
    # kernel reaches two and the normal bias a quarter of one to each side.
    reach = 0.02

    def wall_at(x, y):
        return abs(x - wall_x) <= 1 and 0 <= y <= 2

    def floor_at(x, z):
        if abs(x) > 4 or abs(z) > 4:
            return "dark"
        return "dark" if abs(x - wall_x) < 1 and 0 < z < 2 else "lit"

    around = [(-1, -1), (1, -1), (-1, 1), (1, 1)]

    def ray(column, row):
        x = (2 * (column + 0.5) / width - 1) * tangent * width / height
        y = (1 - 2 * (row + 0.5) / height) * tangent
        return x, ahead[0] + y * above[0], ahead[1] + y * above[1]

    def hits_wall(x, dy, dz):
        wall = -7 / dz if dz < 0 else -1
        return {wall > 0 and wall_at(x * wall + i * 1e-3, 5 + dy * wall + k * 1e-3) for i, k in around}

    def seen(column, row):
        x, dy, dz = ray(column, row)
        hits = hits_wall(x, dy, dz)
        if rim and any(hits_wall(*ray(column + i, row + k)) != hits for i, k in ((-1, 0), (1, 0), (0, -1), (0, 1))):
            return None
        if hits == {True}:
            return "dark"
        floor = -5 / dy if dy < 0 else -1
        kinds = {floor_at(x * floor + i * reach, 7 + dz * floor + k * reach) if floor > 0 else "dark" for i, k in around}
        return kinds.pop() if hits == {False} and len(kinds) == 1 else None

    return [[seen(column, row) for column in range(width)] for row in range(height)]


# The renderer's world (examples/embed/world.cpp): within the clearing stands the tall box and hangs the lamp's ball;
# outside of it everything that moves stays below a height.
CLEARING, HIGHEST_MOVING = 5.6, 1.6
BOX = ((-2.2, 0, -1.6), (-0.6, 3.4, -0.8))
LAMP, LAMP_RADIUS = (2.2, 1.5, -2.0), 0.16
TOWARDS_SUN = (-0.60, 0.52, -0.62)


def along(origin, direction, t):
    return tuple(o + t * d for o, d in zip(origin, direction))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


def hits_box(origin, direction, end):
    """Whether a ray meets the tall box before `end` of its parameter."""
    begin = 0
    for o, d, low, high in zip(origin, direction, *BOX):
        if d == 0:
            if not low < o < high:
                return False
            continue
        first, last = sorted(((low - o) / d, (high - o) / d))
        begin, end = max(begin, first), min(end, last)
    return begin < end


def meets_lamp(origin, direction):
    """Whether a ray passes the lamp's ball by less than twice its radius."""
    to_lamp = minus(LAMP, origin)
    nearest = along(origin, direction, dot(to_lamp, direction) / dot(direction, direction))
    return math.dist(nearest, LAMP) < 2 * LAMP_RADIUS


def leaves_clear(ground, direction):
    """Whether a ray from the ground is above all that moves when it leaves the clearing."""
    at = along(ground, direction, HIGHEST_MOVING / direction[1])
    return math.hypot(at[0], at[2]) < CLEARING


def sun_at(ground):
    if hits_box(ground, TOWARDS_SUN, math.inf):
        return "dark"
    return "lit" if leaves_clear(ground, TOWARDS_SUN) else None


def lamp_at(ground):
    return "dark" if hits_box(ground, minus(LAMP, ground), 1) else "lit"


def clearing_pictures(width, height, eye, target, yfov):
    """V of the sun and of the lamp on the clearing's ground, as a camera at `eye` sees it."""
    ahead = unit(minus(target, eye))
    right = unit(cross(ahead, (0, 1, 0)))
    above = cross(right, ahead)
    tangent = math.tan(yfov / 2)
    # A cascade's texel is a few centimetres here, the kernel reaches two; the cube's texels are smaller.
    reach = 0.25
    around = [(-1, -1), (1, -1), (-1, 1), (1, 1)]

    def ground_at(column, row):
        """The place on the clearing's ground that a point of the picture shows, or None where that is something else."""
        x = (2 * column / width - 1) * tangent * width / height
        y = (1 - 2 * row / height) * tangent
        direction = tuple(a + x * r + y * u for a, r, u in zip(ahead, right, above))
        if direction[1] >= 0:
            return None
        ground = along(eye, direction, -eye[1] / direction[1])
        back = minus((0, 0, 0), direction)
        clear = math.hypot(ground[0], ground[2]) < CLEARING - reach and leaves_clear(ground, back)
        return ground if clear and not hits_box(eye, direction, math.inf) and not meets_lamp(eye, direction) else None

    def decided(ground, light_at):
        kinds = {light_at((ground[0] + i * reach, 0, ground[2] + k * reach)) for i, k in around}
        return kinds.pop() if len(kinds) == 1 else None

    sun, lamp = [], []
    for row in range(height):
        sun.append([None] * width)
        lamp.append([None] * width)
        for column in range(width):
            ground = ground_at(column + 0.5, row + 0.5)
            if ground and all(ground_at(column + 0.5 + 0.4 * i, row + 0.5 + 0.4 * k) for i, k in around):
                sun[-1][column] = decided(ground, sun_at)
                lamp[-1][column] = decided(ground, lamp_at)
    return sun, lamp
