#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""examples/embed, built against an installed copy of a build and run: what foreign renderers do.

    tests/embed_test.py build/release

offline hands over a scene: which of its pixels are lit is known one by one, but for those on an edge; embed_c, in C, lends
depth of the same with a wall that glides, two frames in flight. embed records Gnomon's shadows into frames of its own, under validation, on devices that go without a
feature; V on the open ground is known likewise. A result that is dropped does not compile. embed_baked and embed_c hold no
compiler and no model loader, and embed_baked draws what embed draws from shaders that were baked.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
from embed_pictures import clearing_pictures, compare, read_pgm, read_png, wall_picture  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What Gnomon uses where it is enabled: the renderer goes without any of it, with all, and with all but each.
OPTIONAL = ("samplerAnisotropy", "shaderOutputLayer", "shaderFloat64", "multiDrawIndirect", "drawIndirectFirstInstance",
            "shaderBufferFloat32AtomicAdd", "fragmentShaderPixelInterlock")
REQUIRED = ("dynamicRendering", "synchronization2", "maintenance4", "scalarBlockLayout", "geometryShader", "depthClamp",
            "independentBlend", "logicOp", "sampleRateShading", "imageCubeArray", "fragmentStoresAndAtomics",
            "vertexPipelineStoresAndAtomics", "shaderStorageImageWriteWithoutFormat", "shaderClipDistance",
            "VK_KHR_push_descriptor")
SIZE = (192, 108)


def run(*command, status=0, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if done.returncode != status:
        sys.exit(f"'{' '.join(str(word) for word in command)}' ended with status {done.returncode}, not {status}\n"
                 f"{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout if status == 0 else done.stderr


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


def build_examples(build, folder):
    """Far from the source tree's includes, so that only the installed ones can be found."""
    shutil.rmtree(folder / "prefix", ignore_errors=True)
    run("cmake", "--install", build, "--prefix", folder / "prefix")
    for name in ("embed", "embed_c"):
        source, binary = folder / "source" / name, folder / "build" / name
        shutil.rmtree(source, ignore_errors=True)
        shutil.copytree(ROOT / "examples" / name, source)
        run("cmake", "-G", "Ninja", "-S", source, "-B", binary, f"-DCMAKE_PREFIX_PATH={folder / 'prefix'}",
            "-DCMAKE_CXX_FLAGS=-Og", "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_UNITY_BUILD_BATCH_SIZE=16")
        run("cmake", "--build", binary)


def wall_and_floor(folder, environment):
    """Both ways to the same picture: a scene handed over, and depth lent from C."""
    said = run(folder / "build" / "embed" / "offline", folder / "shadow.png", cwd=folder, env=environment)
    # Edges are lines: the floor's outline, the wall's and the shadow's are some 1500 pixels long.
    decided = compare("shadow.png", read_png(folder / "shadow.png"), wall_picture(rim=False), 5000)
    if decided < 0.95 * 320 * 240:
        sys.exit(f"only {decided} pixels of shadow.png lie off the edges; the test has nothing to compare")
    print(f"{said.strip()}; {decided} compared one by one")
    # The last two frames of the wall that glides, each drawn while the other is in flight: neither has the other's shadow.
    said = run(folder / "build" / "embed_c" / "embed_c", "before.pgm", "shadow.pgm", "--validate", cwd=folder, env=environment)
    for name, wall_x in (("before.pgm", 0.6), ("shadow.pgm", 1.0)):
        compare(name, read_pgm(folder / name), wall_picture(rim=True, wall_x=wall_x), 5000)
    if "nothing" not in said:
        sys.exit(f"embed_c creates in steady frames: {said}")
    print(said.strip())


def holds_no_compiler(folder):
    """What links gnomon::embed has no symbol of a compiler or a loader, and needs no library of them; what compiles has."""
    foreign = re.compile(r"\bshaderc|glslang|spvtools|\bspv[A-Z]|\bspv::|[Aa]ssimp|tinygltf|draco::|meshopt_")
    for name, slim in (("embed/embed", False), ("embed/embed_baked", True), ("embed_c/embed_c", True)):
        program = folder / "build" / name
        symbols = {line for line in run("nm", "-C", program).splitlines() if foreign.search(line)}
        libraries = [line.split()[0] for line in run("ldd", program).splitlines() if foreign.search(line)]
        if slim and (symbols or libraries):
            sys.exit(f"{name} should hold neither compiler nor loader, but needs {libraries} and has {sorted(symbols)[:5]}")
        if not slim and not (symbols and libraries):
            sys.exit(f"{name} compiles and links everything, but 'nm' and 'ldd' show nothing of it: they prove nothing")
    print(f"neither compiler nor loader in embed_baked ({(folder / 'build/embed/embed_baked').stat().st_size >> 10} KiB, with "
          f"both {(folder / 'build/embed/embed').stat().st_size >> 10} KiB)")


class Renderer:
    """Runs of the renderer under validation, in a small picture with few objects."""

    def __init__(self, folder, environment):
        self.folder, self.environment = folder, environment

    program = "embed"

    def run(self, *more, status=0):
        return run(self.folder / "build" / "embed" / self.program, "--validate", "--size", f"{SIZE[0]}x{SIZE[1]}",
                   "--objects", 60, "--frames", 12, "--visibility", "--output", self.folder / "embed.png", *more,
                   status=status, cwd=self.folder, env=self.environment)

    def pictures(self):
        return [(self.folder / f"embed{name}.png").read_bytes() for name in ("", "-sun", "-lamp")]

    def holds(self, *more):
        """Nothing was said, nothing created in steady frames, passes were timed, V is right; gives what it printed."""
        said = self.run(*more)
        for fact in ("frames: 12, 60 moving objects", "created in 6 steady frames: nothing", "validation: 0 messages"):
            if fact not in said:
                sys.exit(f"embed {' '.join(more)} did not say '{fact}' but: {said}")
        if not re.search(r"^passes:( '[^']+'){8}", said, re.M):
            sys.exit(f"embed {' '.join(more)} names too few passes: {said}")
        number = r"(-?[\d.]+)"
        camera = re.search(rf"camera: {number} {number} {number} to {number} {number} {number}, yfov {number}", said)
        eye_and_target = [float(text) for text in camera.groups()]
        expected = clearing_pictures(*SIZE, eye_and_target[:3], eye_and_target[3:6], eye_and_target[6])
        for light, picture in zip(("sun", "lamp"), expected):
            name = f"embed-{light}.png"
            compare(name, read_png(self.folder / name), picture, 50)
        return said

    def refuses(self, word, *more, status=2):
        said = self.run(*more, status=status)
        if len(said.strip().splitlines()) != 1 or word not in said:
            sys.exit(f"embed {' '.join(more)} should name '{word}' in one sentence, and said: {said}")


class BakedRenderer(Renderer):
    """The same without a compiler, and without the folder of sources."""

    program = "embed_baked"

    def __init__(self, folder, environment):
        super().__init__(folder, {**environment, "GNOMON_DATA": str(folder / "no-such-folder")})
        self.baked = ("--baked", folder / "build" / "embed" / "baked")

    def checks(self, compiled):
        """`compiled`: the pictures of embed."""
        self.holds(*self.baked)
        if self.pictures() != compiled:
            sys.exit("embed_baked draws other pictures than embed")
        self.holds(*self.baked, "--with", "all")
        self.refuses("gnomon bake")
        self.refuses("gnomon bake pcf,placement=cascades hard -o", *self.baked, "--recipe", "hard")
        self.refuses("gnomon bake pcf,placement=cascades pcf,placement=lispsm -o", *self.baked,
                     "--recipe", "pcf,placement=lispsm")
        self.refuses("manifest.txt", "--baked", self.folder)
        print("the same pictures from baked shaders")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    folder = build / "embed"
    build_examples(build, folder)
    refuses_dropped_results(folder / "prefix")
    environment = {key: value for key, value in os.environ.items() if key != "GNOMON_DATA"}
    holds_no_compiler(folder)
    wall_and_floor(folder, environment)

    renderer = Renderer(folder, environment)
    print(renderer.holds().strip())
    BakedRenderer(folder, environment).checks(renderer.pictures())
    renderer.holds("--with", "all")
    for feature in OPTIONAL:
        renderer.holds("--with", "all", "--without", feature)
    renderer.holds("--draw-casters")
    renderer.refuses("map 'vsm'", "--draw-casters", "--recipe", "vsm")
    for feature in REQUIRED:
        renderer.refuses(feature, "--without", feature)
    renderer.refuses("'volumes'", "--recipe", "volumes")
    renderer.refuses("samplerAnisotropy", "--without", "flying", status=1)
    print(f"the same without {len(OPTIONAL)} features; refused without each of {len(REQUIRED)}")


if __name__ == "__main__":
    main()
