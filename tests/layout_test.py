#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The shape of the tree: every rule of layout_rules.py holds here and finds the breach it is for in a tiny bad tree.

    tests/layout_test.py [ROOT]     ends with the ten largest files and the line: N passed, N failed
"""

import functools
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.dont_write_bytecode = True
import layout_rules as rules  # noqa: E402

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
ROOT = ROOT if ROOT.is_dir() else ROOT.parent.parent
SPDX = "// SPDX-License-Identifier: MIT\n"

# One good part and one good recipe; each bad tree is this with something added or replaced.
GOOD = {
    "docs/references.bib": "% SPDX-License-Identifier: MIT\n@article{Wil78,\n}\n",
    "base/error.h": SPDX,
    "shadow/lookup/soft/soft.cpp": SPDX + '// Based on: Williams. Title. Venue 1978. [Wil78]\n\nnamespace gn::parts {\n\n'
                                   "const Part& lookup_soft() {\n    static const Part part = [] {\n        Part p;\n"
                                   '        p.id = "soft";\n        p.stage = Stage::lookup;\n        p.citation = "Wil78";\n'
                                   "        return p;\n    }();\n    return part;\n}\n\n}\n",
    "shadow/lookup/soft/soft_test.cpp": SPDX + '#include "base/error.h"\n',
    "shadow/lookup/soft/soft.md": "---\ntitle: Soft\nauthors: Williams\nyear: 1978\nkey: Wil78\nstage: lookup\n---\n",
    "shadow/lookup/soft/soft.glsl": SPDX + "#ifndef GN_SOFT_GLSL\n#define GN_SOFT_GLSL\nfloat gn_soft(float x) {\n"
                                           "    return x;\n}\n#endif\n",
    "recipes/soft.toml": '# SPDX-License-Identifier: MIT\ntitle = "Soft"\nparagraph = "Why."\ncitation = "Wil78"\n'
                         'lookup = "soft"\n',
}
GLSL = GOOD["shadow/lookup/soft/soft.glsl"]
PART = "shadow/lookup/soft/soft"
MUTANT = '# SPDX-License-Identifier: MIT\n[[mutant]]\nlaw = "It is x."\nfile = "shadow/lookup/soft/soft.glsl"\n' \
         'before = "{}"\nafter = "return 0.0;"\ntest = "{}"\ncases = "Soft.*"\n'

# rule, what is changed in the good tree (None removes), a word of the complaint
BREACHES = [
    (rules.part_shape, {f"{PART}_test.cpp": None}, "is missing"),
    (rules.part_shape, {f"{PART}.md": None}, "is missing"),
    (rules.part_shape, {"shadow/lookup/soft/notes.txt": "x"}, "neither one of the five"),
    (rules.part_shape, {"shadow/lookup/Soft-2/x.cpp": SPDX}, "lower-case"),
    (rules.part_shape, {f"{PART}.cpp": SPDX + "// Also here: absent.comp (edges)\n"}, "which is not there"),
    (rules.part_definitions, {f"{PART}.cpp": GOOD[f"{PART}.cpp"].replace("= [] {", "{")}, "as its siblings do"),
    (rules.unnamed_names, {f"{PART}.cpp": GOOD[f"{PART}.cpp"] + "namespace gn {\nnamespace {\n}\n}\n"}, "gn::parts::soft"),
    (rules.unnamed_names, {f"{PART}_test.cpp": SPDX + "namespace gn {\nnamespace {\n}\n}\n"}, "gn::soft_test"),
    (rules.layering, {"base/a.cpp": SPDX + '#include "gpu/device.h"\n'}, "gpu/device.h"),
    (rules.layering, {"gpu/a.cpp": SPDX + '#include "shadow/recipe/part.h"\n'}, "shadow/recipe/part.h"),
    (rules.layering, {"shadow/scene/a.cpp": SPDX + '#include "gpu/device.h"\n'}, "gpu/device.h"),
    (rules.layering, {"shadow/scene/a.cpp": SPDX + '#include "shadow/scene/files/obj.h"\n'}, "files of scenes"),
    (rules.layering, {"shadow/metrics/a.cpp": SPDX + '#include "shadow/recipe/part.h"\n'}, "shadow/recipe/part.h"),
    (rules.layering, {"shadow/frame/frame.cpp": SPDX + '#include "reference/truth.h"\n'}, "reference/truth.h"),
    (rules.layering, {"reference/a.cpp": SPDX + '#include "shadow/recipe/part.h"\n'}, "shadow/recipe/part.h"),
    (rules.layering, {"reference/a.cpp": SPDX + '#include "gpu/device.h"\n'}, "gpu/device.h"),
    (rules.one_definition, {"gpu/a.cpp": SPDX + "namespace gn {\nstruct Slot {\n};\n}  // namespace gn\n",
                            "apps/b.h": SPDX + "namespace gn {\nclass Slot {\n};\n}  // namespace gn\n"}, "gn::Slot"),
    (rules.layering, {"base/a_test.cpp": SPDX + '#include "shadow/recipe/part.h"\n'}, "shadow/recipe/part.h"),
    (rules.parts_are_strangers, {f"{PART}.cpp": SPDX + '#include "shadow/map/depth/depth.h"\n'}, "another part"),
    (rules.stages_are_strangers, {"shadow/lookup/a.cpp": SPDX + '#include "shadow/map/derived.h"\n'}, "belongs into a room"),
    (rules.includes_resolve, {"base/a.cpp": SPDX + '#include "base/absent.h"\n'}, "base/absent.h"),
    (rules.stages_are_strangers, {"shadow/lookup/a.cpp": SPDX + '#include "shadow/map/derived.h"\n'}, "belongs into a room"),
    (rules.includes_resolve, {"base/a.cpp": SPDX + '#include "error.h"\n'}, "error.h"),
    (rules.folder_names, {"gpu/utils/a.cpp": SPDX}, "utils"),
    (rules.file_sizes, {"base/a.cpp": SPDX + "\n" * 600}, "601 lines"),
    (rules.licence_lines, {"base/a.cpp": "int x;\n"}, "base/a.cpp"),
    (rules.licence_lines, {"tools/run": "#!/bin/sh\necho\n"}, "tools/run"),
    (rules.citations, {f"{PART}.cpp": SPDX + "// Based on: A. B. C 1978. [Wil78]\n"}, "sets no citation"),
    (rules.citations, {f"{PART}.cpp": SPDX + '// Based on: A. B. C 1978. [Wil78]\nx.citation = "Xyz99";\n'}, "Xyz99"),
    (rules.citations, {f"{PART}.cpp": SPDX + 'x.citation = "Wil78";\n'}, "Based on"),
    (rules.keys_exist, {"base/a.cpp": SPDX + "// as in [Xyz99] eq. 5\n"}, "Xyz99"),
    (rules.keys_exist, {"docs/flow.md": "see [ABC+12]\n"}, "ABC+12"),
    (rules.keys_exist, {"docs/references.bib": "@a{Wil78,\n}\n@a{Wil78,\n}\n"}, "twice"),
    (rules.chained_matrices, {"base/a.cpp": SPDX + "mat4 ws_to_cs;\n"}, "ws_to_cs"),
    (rules.chained_matrices, {"base/a.glsl": SPDX + "mat4 worldToLight;\n"}, "worldToLight"),
    (rules.machine_paths, {"base/a.cpp": SPDX + '"/home/me/x"\n'}, "/home/"),
    (rules.machine_paths, {"base/a.cpp": SPDX + "// TODO later\n"}, "TODO"),
    (rules.pages_exist, {"base/a.cpp": SPDX + "// See docs/absent.md.\n"}, "absent.md"),
    (rules.issue_numbers, {"base/a.cpp": SPDX + "// closes issue 12\n"}, "issue 12"),
    (rules.portable_glsl, {f"{PART}.glsl": "#version 460\n" + GLSL}, "a version"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "layout(binding = 0) uniform sampler2D gn_map;\n"}, "a layout"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "uniform float gn_x;\n"}, "a uniform"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "float soft(float x) { return x; }\n"}, "'soft'"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "GN_FN vec2 soft(vec2 x) { return x; }\n"}, "'soft'"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "const float taps[2] = float[](1.0, 2.0);\n"}, "'taps'"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "struct Soft {\n"}, "'Soft'"),
    (rules.portable_glsl, {f"{PART}.glsl": GLSL + "#define SOFT 1\n"}, "'SOFT'"),
    (rules.portable_glsl, {f"{PART}.glsl": SPDX + "float gn_soft(float x) { return x; }\n"}, "guard"),
    (rules.portable_glsl, {"shadow/lookup/soft/soft_more.glsl": GLSL + "float taps(float x) { return x; }\n"}, "'taps'"),
    (rules.portable_glsl, {"shadow/view/pixel.glsl": SPDX + "void main() {}\n"}, "guard"),
    (rules.long_shader_texts, {"shadow/view/a.cpp": SPDX + 'const char* text = R"(\n' + "x;\n" * 50 + ')";\n'}, "51 lines"),
    (rules.named_bindings, {"shadow/view/a.cpp": SPDX + "layout(binding = 3) uniform sampler2D map;\n"}, "by hand"),
    (rules.named_bindings, {"shadow/view/a_test.cpp": SPDX + "layout(binding = 3) uniform sampler2D map;\n"}, "by hand"),
    (rules.named_bindings, {"shadow/view/a.cpp": SPDX + "layout(scalar) readonly buffer Views { int views[]; };\n"}, "by hand"),
    (rules.named_bindings, {"shadow/view/a.h": SPDX + "uniform Constants { int x; } u;\n"}, "by hand"),
    (rules.mutants, {"tests/mutants/soft.toml": MUTANT.format("return y;", "base/error_test.cpp")}, "0 times"),
    (rules.mutants, {"tests/mutants/soft.toml": MUTANT.format("return x;", "base/absent_test.cpp")}, "base/absent_test.cpp"),
    (rules.recipes, {"recipes/soft.toml": GOOD["recipes/soft.toml"] + 'map = "absent"\n'}, "absent"),
    (rules.recipes, {"recipes/soft.toml": 'title = "a"\ncitation = "Wil78"\n'}, "paragraph"),
    (rules.recipes, {"recipes/soft.toml": 'title = "a"\nparagraph = "b"\ncitation = "Xyz99"\n'}, "Xyz99"),
    (rules.recipes, {"recipes/soft.toml": "title =\n"}, "no TOML"),
    (rules.recipes, {"recipes/soft.toml": GOOD["recipes/soft.toml"] + 'direct = "soft"\n'}, "no combine says"),
    (rules.manual_pages, {f"{PART}.md": "# Soft\n"}, "front matter"),
    (rules.manual_pages, {f"{PART}.md": GOOD[f"{PART}.md"].replace("stage: lookup", "stage: map")}, "stage map"),
    (rules.manual_pages, {f"{PART}.md": GOOD[f"{PART}.md"].replace("Wil78", "Xyz99")}, "Xyz99"),
]


def make_tree(folder, change):
    for name, text in {**GOOD, **change}.items():
        if text is not None:
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
    return rules.Tree(folder)


class Here(unittest.TestCase):
    """One test a rule, made below: the real tree breaks none."""


class Breaches(unittest.TestCase):
    """One test a row of BREACHES, made below: the rule notices, and says so in its words."""

    def test_good_tree_breaks_no_rule(self):
        with tempfile.TemporaryDirectory() as folder:
            tree = make_tree(folder, {})
            for rule in rules.ALL:
                self.assertEqual(rule(tree), [], rule.__name__)

    def test_every_rule_has_a_breach(self):
        self.assertEqual({rule for rule, _, _ in BREACHES}, set(rules.ALL))


class NewPart(unittest.TestCase):
    """tools/new_part stamps parts that keep every rule and compile, and refuses what could not become one."""

    def stamp(self, root, *arguments):
        return subprocess.run([sys.executable, str(ROOT / "tools" / "new_part"), *arguments, "--root", root],
                              capture_output=True, text=True, check=False)

    def test_stamped_parts_keep_the_rules_and_compile(self):
        with tempfile.TemporaryDirectory() as root:
            make_tree(root, {})
            for stage in rules.STAGES:
                done = self.stamp(root, stage, f"trial-{stage}", "--key", "Wil78")
                self.assertEqual(done.returncode, 0, done.stderr)
            # What the stamped files include is the real tree's; every other rule must hold in the small one.
            stamped = rules.Tree(root)
            for rule in set(rules.ALL) - {rules.includes_resolve}:
                self.assertEqual(rule(stamped), [], rule.__name__)
            self.compile_together(root, [f"shadow/{stage}/trial_{stage}/trial_{stage}.cpp" for stage in rules.STAGES])

    def compile_together(self, root, sources):
        """As the build does with neighbours, which also shows that none takes another's names."""
        flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wno-missing-field-initializers", "-Werror"]
        flags += [f"-DGLM_FORCE_{name}" for name in ("DEPTH_ZERO_TO_ONE", "RADIANS")] + ["-DGLM_ENABLE_EXPERIMENTAL"]
        done = subprocess.run(["g++", *flags, f"-I{ROOT}", f"-I{root}", "-x", "c++", "-"], capture_output=True, text=True,
                              input="".join(f'#include "{pathlib.Path(root) / source}"\n' for source in sources), check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_an_unset_citation_is_noticed(self):
        with tempfile.TemporaryDirectory() as root:
            make_tree(root, {})
            self.stamp(root, "lookup", "trial")
            self.assertTrue(any("Key00" in complaint for complaint in rules.citations(rules.Tree(root))))

    def test_refusals_are_one_sentence_and_leave_nothing(self):
        wrong = (("lookup", "Soft2"), ("lookup", "a_b"), ("lookup", "../up"), ("lookup", "a--b"), ("lookup", "auto"),
                 ("lookup", "soft"), ("map", "soft"), ("shading", "x"), ("lookup", "x", "--key", "Nope00"))
        with tempfile.TemporaryDirectory() as root:
            before = make_tree(root, {}).files
            for arguments in wrong:
                done = self.stamp(root, *arguments)
                self.assertEqual(done.returncode, 1, arguments)
                self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertEqual(rules.Tree(root).files, before)


@functools.cache
def real_tree():
    """Read once: nothing here changes it."""
    return rules.Tree(ROOT)


def here_test(rule):
    def test(self):
        complaints = rule(real_tree())
        self.assertFalse(complaints, f"{rule.__doc__}\n  " + "\n  ".join(complaints))

    return test


def breach_test(rule, change, word):
    def test(self):
        with tempfile.TemporaryDirectory() as folder:
            complaints = rule(make_tree(folder, change))
        self.assertTrue(any(word in complaint for complaint in complaints), f"'{word}' is in none of {complaints}")

    return test


for checked in rules.ALL:
    setattr(Here, f"test_{checked.__name__}", here_test(checked))
for index, (checked, changes, expected) in enumerate(BREACHES):
    setattr(Breaches, f"test_{checked.__name__}_{index}", breach_test(checked, changes, expected))


def main():
    suite = unittest.TestSuite(unittest.defaultTestLoader.loadTestsFromTestCase(case) for case in (Here, Breaches, NewPart))
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=0).run(suite)
    print("largest files: " + ", ".join(f"{name} {lines}" for lines, name in rules.largest_files(real_tree(), 10)))
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
