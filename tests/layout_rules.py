# SPDX-License-Identifier: MIT
"""The rules of the tree, one function each: it takes a Tree and returns its complaints, one sentence a breach.

layout_test.py runs each on the real tree, where it must find nothing, and on a tiny bad tree, where it must find something.
"""

import os
import pathlib
import re
import subprocess
import tomllib

STAGES = ("light", "placement", "map", "lookup", "direct", "visibility")
SOURCES = {".cpp", ".h", ".glsl", ".comp", ".frag", ".vert", ".geom"}
SHADERS = {".glsl", ".comp", ".frag", ".vert", ".geom"}
SCRIPTS = {".py", ".cmake", ".toml", ".html", ".css", ".js", ".bib", ".sh"}
LINE_LIMIT = 600
SCREEN = 50
KEY = r"[A-Z][A-Za-z]{0,5}\+?\d\d[a-z]?"


class Tree:
    """The files under a root, without what git ignores, and their text."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        listed = None
        if (self.root / ".git").exists():
            listed = subprocess.run(["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                    capture_output=True, text=True, check=False).stdout.split("\0")
        if not listed:
            listed = [str(path.relative_to(root)) for path in self.root.rglob("*") if "build" not in path.parts]
        self.files = sorted({name for name in listed if name and (self.root / name).is_file()})
        self._texts = {}

    def text(self, name):
        if name not in self._texts:
            self._texts[name] = (self.root / name).read_text(encoding="utf-8", errors="replace")
        return self._texts[name]

    def having(self, suffixes, under=""):
        return [name for name in self.files if pathlib.Path(name).suffix in suffixes and name.startswith(under)]

    def parts(self):
        """Every part folder as (stage, folder name, its files)."""
        found = {}
        for name in self.files:
            pieces = name.split("/")
            if len(pieces) >= 4 and pieces[0] == "shadow" and pieces[1] in STAGES:
                found.setdefault((pieces[1], pieces[2]), []).append("/".join(pieces[3:]))
        return [(stage, folder, files) for (stage, folder), files in sorted(found.items())]

    def bibliography(self):
        name = "docs/references.bib"
        return set(re.findall(r"^@\w+\{([^,\s]+),", self.text(name), re.M)) if name in self.files else set()


def is_test(name):
    return name.endswith("_test.cpp") or name.startswith("tests/")


def comments_of(text):
    """What stands after // on each line, as (line number, comment); addresses such as https:// are no comments."""
    for number, line in enumerate(text.splitlines(), 1):
        found = re.search(r"(?<!:)//(.*)", line)
        if found:
            yield number, found[1]


def head_of(text):
    """The comment at a file's head as one line, each statement (`Based on:`, `Also here:`) after a newline of its own."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("//"):
            break
        lines.append(line[2:].strip())
    return re.sub(r" (?=(?:Based on|Departs from it|Also here|Stands on): )", "\n", " ".join(lines))


def part_shape(tree):
    """A part folder holds the five files of its siblings; others are announced in its .cpp: `// Also here: a.comp`."""
    complaints = []
    for stage, folder, files in tree.parts():
        where = f"shadow/{stage}/{folder}"
        if not re.fullmatch(r"[a-z][a-z0-9_]*", folder):
            complaints.append(f"{where}: a part's folder is lower-case letters, digits and '_'")
        for required in (f"{folder}.cpp", f"{folder}_test.cpp", f"{folder}.md"):
            if required not in files:
                complaints.append(f"{where}: {required} is missing")
        own = {folder + ending for ending in (".h", ".glsl", ".cpp", "_test.cpp", ".md")}
        announced = set()
        if f"{folder}.cpp" in files:
            for line in re.findall(r"^Also here: (.*)$", head_of(tree.text(f"{where}/{folder}.cpp")), re.M):
                announced |= set(re.findall(r"[\w]+\.\w+", line))
        for extra in sorted(set(files) - own - announced):
            complaints.append(f"{where}: {extra} is neither one of the five files nor announced by "
                              f"'// Also here: {extra}' in {folder}.cpp")
        for absent in sorted(announced - set(files)):
            complaints.append(f"{where}: {folder}.cpp announces {absent}, which is not there")
    return complaints


def part_definitions(tree):
    """Every part's .cpp ends with its one function: `namespace parts`, in it `static const Part part = [] { Part p; p.id = ...`,
    `p.stage = ...`; helpers stand before it in namespaces of their own."""
    complaints = []
    for stage, folder, files in tree.parts():
        if f"{folder}.cpp" not in files:
            continue
        where = f"shadow/{stage}/{folder}/{folder}.cpp"
        shape = (rf"\nnamespace (?:gn::)?parts {{\n\nconst Part& {stage}_{folder}\(\) {{\n(?:    using namespace [a-z_:]+;\n)?    static const Part part = \[\] {{\n"
                 rf'        Part p;\n        p\.id = "{folder.replace("_", "-")}";\n        p\.stage = Stage::{stage};\n')
        if not re.search(shape, tree.text(where)):
            complaints.append(f"{where}: define the part as its siblings do: const Part& {stage}_{folder}() in namespace parts, "
                              "a lambda that fills `Part p`, id and stage first")
    return complaints


def unnamed_names(tree):
    """Eight sources compile as one: what parts and tests call alike stands in namespaces of their own, not in gn's unnamed one."""
    main = {f"shadow/{stage}/{folder}/{folder}.cpp": f"gn::parts::{folder}" for stage, folder, _ in tree.parts()}
    complaints = []
    for name in tree.having({".cpp"}):
        own = f"gn::{pathlib.Path(name).stem}" if name.endswith("_test.cpp") else main.get(name)
        if own and re.search(r"^namespace gn {\nnamespace {$", tree.text(name), re.M):
            complaints.append(f"{name}: its unnamed namespace stands in gn; put it into namespace {own}")
    return complaints


def one_definition(tree):
    """A type that other sources could see has its name to itself: of two the linker would take one's functions for both."""
    places = {}
    for name in tree.having({".cpp", ".h"}):
        spaces = []
        for line in () if name.startswith("examples/") else tree.text(name).splitlines():
            if opened := re.match(r"namespace( [\w:]+)? \{", line):
                spaces.append((opened[1] or "").strip())
            elif line.startswith("}  // namespace") and spaces:
                spaces.pop()
            elif (defined := re.match(r"(?:struct|class|union) (\w+)(?: final)?(?: : [^;]*)? \{", line)) and "" not in spaces:
                places.setdefault("::".join([*spaces, defined[1]]), []).append(name)
    return [f"{found[1]}: {entity} is defined in {found[0]} too; give one another name or an unnamed namespace"
            for entity, found in places.items() if len(found) > 1]


# Who may include what: the first row whose prefix fits a file decides.
LAYERS = (
    ("base/", ("base/",)),
    ("gpu/", ("base/", "gpu/")),
    ("shadow/scene/", ("base/", "shadow/scene/", "scenes/")),
    ("scenes/", ("base/", "shadow/scene/", "scenes/")),
    ("shadow/metrics/", ("base/", "shadow/metrics/")),
    ("shadow/", ("base/", "gpu/", "shadow/", "scenes/")),
    ("reference/", ("base/", "shadow/scene/", "reference/")),
    ("apps/", ("base/", "gpu/", "shadow/", "scenes/", "reference/", "apps/")),
)


def includes_of(tree, name):
    return re.findall(r'^\s*#\s*include\s+"([^"]+)"', tree.text(name), re.M)


def layering(tree):
    """base <- gpu <- shadow <- apps; reference <- base + the CPU half of scene; metrics <- base."""
    complaints = []
    for name in tree.having(SOURCES):
        allowed = next((row for prefix, row in LAYERS if name.startswith(prefix)), None)
        if allowed is None:
            continue
        if name.startswith("shadow/scene/") and re.search(r"_gpu(_test)?\.\w+$", name):
            allowed += ("gpu/", "shadow/")
        if is_test(name):
            allowed += ("tests/thorough.h",)  # how much of a suite runs
        # A stage's test may measure against the truth; the layers below may not.
        if is_test(name) and name.startswith(("shadow/", "reference/")):
            allowed += ("reference/", "shadow/metrics/", "shadow/scene/", "scenes/", "tests/")
        for include in includes_of(tree, name):
            if "/" in include and not include.startswith(allowed):
                complaints.append(f"{name}: includes {include}, but may include only {', '.join(allowed)}")
            # What a scene is knows no file that holds one: a renderer embeds the first alone.
            if include.startswith("shadow/scene/files/") and name.startswith("shadow/") and not name.startswith(
                    "shadow/scene/files/") and not is_test(name):
                complaints.append(f"{name}: includes {include}, but only shadow/scene/files and apps know files of scenes")
    return complaints


def parts_are_strangers(tree):
    """A part that builds on another says so in its .cpp: `// Stands on: shadow/map/depth (why)`. Tests need not."""
    complaints = []
    for stage, folder, files in tree.parts():
        own = f"shadow/{stage}/{folder}/"
        text = tree.text(f"{own}{folder}.cpp") if f"{folder}.cpp" in files else ""
        allowed = tuple(f"{path}/" for line in re.findall(r"^Stands on: (.*)$", head_of(text), re.M)
                        for path in re.findall(r"shadow/\w+/\w+", line)) + (own,)
        for file in files:
            name = own + file
            if pathlib.Path(name).suffix not in SOURCES or is_test(name):
                continue
            for include in includes_of(tree, name):
                pieces = include.split("/")
                if len(pieces) >= 4 and pieces[1] in STAGES and not include.startswith(allowed):
                    complaints.append(f"{name}: includes {include} of another part; say '// Stands on: "
                                      f"{'/'.join(pieces[:3])}' in {folder}.cpp, or move what both need to the stage")
    return complaints


def stages_are_strangers(tree):
    """No stage leans on another, and no room on a stage: what two need stands in a room. `// Stands on:` names exceptions."""
    complaints = []
    stages = STAGES + ("shading",)
    for name in (file for file in tree.having(SOURCES, "shadow/") if not is_test(file)):
        own = name.split("/")[1]
        if own not in stages + ("receiver", "casters", "geometry", "recipe"):
            continue
        stands_on = re.findall(r"^Stands on: (.*)$", head_of(tree.text(name)), re.M)
        for include in includes_of(tree, name):
            pieces = include.split("/")
            if pieces[0] != "shadow" or len(pieces) != 3 or pieces[1] == own or pieces[1] not in stages:
                continue
            if not any(include.rsplit(".", 1)[0] in line for line in stands_on):
                complaints.append(f"{name}: includes {include} of another stage; what both need belongs into a room")
    return complaints


def includes_resolve(tree):
    """A quoted include is a path from the root, and it is there."""
    complaints = []
    known = set(tree.files)
    for name in tree.having(SOURCES):
        if name.startswith("examples/"):
            continue
        for include in includes_of(tree, name):
            if include not in known:
                complaints.append(f"{name}: includes \"{include}\", which is no file of the tree (paths start at the root)")
    return complaints


def folder_names(tree):
    """No folder is a grab-bag."""
    forbidden = {"common", "utils", "util", "misc", "helpers", "helper", "shared", "core", "lib"}
    folders = {parent for name in tree.files for parent in pathlib.PurePosixPath(name).parents}
    return [f"{folder}: a folder says what it holds; '{folder.name}' does not"
            for folder in sorted(folders) if folder.name in forbidden]


def file_sizes(tree):
    """No source is longer than the budget."""
    return [f"{name}: {lines} lines, the budget is {LINE_LIMIT}" for lines, name in largest_files(tree, None)
            if lines > LINE_LIMIT]


def largest_files(tree, count):
    sizes = [(len(tree.text(name).splitlines()), name) for name in tree.having(SOURCES | SCRIPTS)]
    return sorted((size for size in sizes if not size[1].endswith(".bib")), reverse=True)[:count]


def licence_lines(tree):
    """The first line names the licence; in a script the second, after #!; on a page one of the first three."""
    complaints = []
    named = {"Makefile", "CMakeLists.txt", ".editorconfig", ".clang-tidy"}
    for name in tree.files:
        path = pathlib.Path(name)
        text = tree.text(name) if path.suffix in SOURCES | SCRIPTS or path.name in named or not path.suffix else ""
        script = text.startswith("#!")
        if not (script or path.suffix in SOURCES | SCRIPTS or path.name in named):
            continue
        if "SPDX-License-Identifier: MIT" not in "\n".join(text.splitlines()[: 3 if name.endswith(".html") else 2 if script else 1]):
            complaints.append(f"{name}: the first line lacks 'SPDX-License-Identifier: MIT'")
    return complaints


def citations(tree):
    """Every part cites a work of docs/references.bib, in its .cpp and at the head of the file that implements it."""
    complaints = []
    known = tree.bibliography()
    for stage, folder, files in tree.parts():
        where = f"shadow/{stage}/{folder}"
        if f"{folder}.cpp" not in files:
            continue
        field = re.search(r"\bcitation\s*=\s*\"([^\"]*)\"", tree.text(f"{where}/{folder}.cpp"))
        keys = re.split(r"[,;\s]+", field[1]) if field and field[1] else []
        if not keys:
            complaints.append(f"{where}/{folder}.cpp: sets no citation, a key of docs/references.bib")
        complaints += [f"{where}/{folder}.cpp: cites {key}, which docs/references.bib lacks"
                       for key in keys if key not in known]
        heads = [head_of(tree.text(f"{where}/{file}")) for file in files if pathlib.Path(file).suffix in SOURCES]
        based = [key for head in heads for key in re.findall(rf"^Based on: .*?\[({KEY})\]", head, re.M)]
        if not based:
            complaints.append(f"{where}: no file begins with '// Based on: Authors. Title. Venue Year. [Key]'")
    return complaints


def keys_exist(tree):
    """Every [Key] in a comment or on a page is in docs/references.bib, and the bibliography names none twice."""
    known = tree.bibliography()
    complaints = []
    for name in tree.having(SOURCES):
        for number, comment in comments_of(tree.text(name)):
            complaints += [f"{name}:{number}: cites [{key}], which docs/references.bib lacks"
                           for key in re.findall(rf"\[({KEY})\](?!\()", comment) if key not in known]
    for name in tree.having({".md"}):
        complaints += [f"{name}: cites [{key}], which docs/references.bib lacks"
                       for key in re.findall(rf"\[({KEY})\](?!\()", tree.text(name)) if key not in known]
    if "docs/references.bib" in tree.files:
        entries = re.findall(r"^@\w+\{([^,\s]+),", tree.text("docs/references.bib"), re.M)
        complaints += [f"docs/references.bib: {key} stands there twice" for key in sorted(set(entries))
                       if entries.count(key) > 1]
    return complaints


def chained_matrices(tree):
    """Matrices chain: cs_from_ws, never ws_to_cs."""
    space = r"(?:ws|vs|ls|cs|ts|ss|os|world|view|light|clip|texture|screen|camera|eye|model|object)"
    wrong = re.compile(rf"\b\w*?{space}_to_{space}\b|\b{space}To(?:World|View|Light|Clip|Texture|Screen|Camera|Eye)\b")
    return [f"{name}: '{word}' reads against the chain; name it target_from_source"
            for name in tree.having(SOURCES) for word in sorted(set(wrong.findall(tree.text(name))))]


def machine_paths(tree):
    """No path of one machine, and no note to oneself, in what is shipped."""
    path = re.compile(r"(?<![\w.])/(?:work|home|root|tmp|Users)/[\w.]|\b(?:TODO|FIXME|XXX)\b")
    complaints = []
    for name in tree.having(SOURCES | SCRIPTS | {".md", ".json"}):
        if is_test(name):
            continue
        for number, line in enumerate(tree.text(name).splitlines(), 1):
            found = path.search(line)
            if found:
                complaints.append(f"{name}:{number}: '{found[0]}' means nothing on another machine or to another reader")
    return complaints


def pages_exist(tree):
    """A page that a comment names, or that another page names with its folder or links to, is there; a picture too."""
    known = {pathlib.PurePosixPath(name).name for name in tree.having({".md"})}
    named = re.compile(r"(?<![\w<>*/])(?:[\w.-]+/)*([A-Za-z][\w-]*\.md)\b")
    linked = re.compile(r"(?:\]\(|/)([A-Za-z][\w-]*\.md)\b")
    complaints = []
    for name in tree.having(SOURCES):
        for _, comment in comments_of(tree.text(name)):
            complaints += [f"{name}: points to {page}, which is not in the tree"
                           for page in named.findall(comment) if page not in known]
    for name in tree.having({".md"}):
        complaints += [f"{name}: points to {page}, which is not in the tree"
                       for page in linked.findall(tree.text(name)) if page not in known]
        here = pathlib.PurePosixPath(name).parent
        complaints += [f"{name}: shows {picture}, which is not in the tree"
                       for picture in re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", tree.text(name))
                       if os.path.normpath(here / picture) not in tree.files]
    return complaints


def issue_numbers(tree):
    """Code explains itself: it refers to no ticket by number."""
    wrong = re.compile(r"\b[Ii]ssue #?\d+|\(#\d+\)")
    return [f"{name}:{number}: '{found[0]}' cannot be read from the tree alone"
            for name in tree.having(SOURCES | SCRIPTS | {".md"}) if not name.startswith("tests/layout_")
            for number, line in enumerate(tree.text(name).splitlines(), 1) if (found := wrong.search(line))]


def portable_glsl(tree):
    """A .glsl goes into anybody's shader: functions only, every name with our prefix, guarded. Without a guard it is the body
    of one shader of ours, which the .cpp beside it completes, and no part's own <id>.glsl."""
    complaints = []
    for name in tree.having({".glsl"}, "shadow/"):
        text = re.sub(r"/\*.*?\*/", "", tree.text(name), flags=re.S)
        text = re.sub(r"//.*", "", text)
        guarded = re.search(r"^#ifndef\s+(GN_\w+)\s*\n#define\s+\1", text, re.M)
        if not guarded:
            complaints += [] if is_shader_body(tree, name) else [f"{name}: has no include guard"]
            continue
        for word, meaning in (("#version", "a version"), (r"\blayout\s*\(", "a layout"), (r"^\s*uniform\b", "a uniform"),
                              (r"^\s*(?:in|out)\s+\w+\s+\w+\s*;", "a stage variable"), (r"\bvoid\s+main\s*\(", "main")):
            if re.search(word, text, re.M):
                complaints.append(f"{name}: has {meaning}; a portable file has functions only")
        names = re.findall(r"^#\s*define\s+(\w+)", text, re.M) + re.findall(r"^struct\s+(\w+)", text, re.M)
        names += re.findall(r"^(?:GN_FN\s+)?(?:const\s+)?(?!return\b|else\b|namespace\b|using\b)\w+\s+(\w+)\s*(?:\[[^\]]*\]\s*)?[(=;]",
                            text, re.M)
        complaints += [f"{name}: '{word}' lacks the prefix gn_, Gn or GN_" for word in sorted(set(names))
                       if not re.match(r"gn_|Gn|GN_", word)]
    return complaints


def is_shader_body(tree, name):
    """Whether a source beside a .glsl, or another body there, names it in an #include of its text."""
    path = pathlib.PurePosixPath(name)
    beside = [other for other in tree.having({".cpp", ".glsl"}) if pathlib.PurePosixPath(other).parent == path.parent]
    named = rf"{re.escape(str(path.parent))}/(?:{re.escape(path.name)}|{re.escape(path.stem.rsplit('_', 1)[0])}_\{{\}}\.glsl)"
    return path.stem != path.parent.name and any(re.search(named, tree.text(other)) for other in beside if other != name)


def long_shader_texts(tree):
    """GLSL longer than a screen stands in a file beside its .cpp."""
    return [f"{name}:{tree.text(name)[:found.start()].count(chr(10)) + 1}: {found[1].count(chr(10))} lines of GLSL; give them a "
            f".glsl beside it" for name in tree.having({".cpp"}, "shadow/") if not is_test(name)
            for found in re.finditer(r'R"\((.*?)\)"', tree.text(name), re.S) if found[1].count("\n") > SCREEN]


def named_bindings(tree):
    """Shaders of shadow/ and of its tests declare what they read through ShaderInputs, by name: no binding number and no
    block by hand. What tests of the layer below try, and the foreign renderers, count for themselves."""
    complaints = []
    by_hand = (r"\bbinding\s*=\s*\d", r"^\s*(?:layout\s*\([^)]*\)\s*)?(?:(?:read|write)only\s+)?(?:uniform|buffer)\s+\w+\s*\{")
    ours = [file for file in tree.having(SOURCES) if file.startswith(("shadow/", "tests/"))]
    for name in (file for file in ours if not file.startswith("tests/performance/")):
        for number, line in enumerate(tree.text(name).splitlines(), 1):
            if "push_constant" not in line and any(re.search(word, line) for word in by_hand):
                complaints.append(f"{name}:{number}: numbers a binding by hand: {line.strip()}; ShaderInputs declares it by name")
    return complaints


def recipes(tree):
    """A recipe names parts that exist, says why one would use it, and cites a work."""
    complaints = []
    known = tree.bibliography()
    there = {(stage, folder) for stage, folder, _ in tree.parts()}
    for name in (file for file in tree.having({".toml"}, "recipes/")):
        try:
            recipe = tomllib.loads(tree.text(name))
        except tomllib.TOMLDecodeError as error:
            complaints.append(f"{name}: is no TOML ({error})")
            continue
        complaints += [f"{name}: '{key}' is missing" for key in ("title", "paragraph", "citation") if not recipe.get(key)]
        complaints += [f"{name}: cites {key}, which docs/references.bib lacks"
                       for key in re.findall(r"[^\s,;]+", str(recipe.get("citation", ""))) if key not in known]
        for stage in STAGES:
            named = recipe.get(stage, [])
            for part in named if isinstance(named, list) else [named]:
                if part in ("", "auto") or (stage, part.replace("-", "_")) in there:
                    continue
                complaints.append(f"{name}: {stage} = '{part}', but shadow/{stage}/{part.replace('-', '_')}/ is not there")
        if "direct" in recipe and ("map" in recipe or "lookup" in recipe) and "combine" not in recipe:
            complaints.append(f"{name}: has direct and a map or lookup, and no combine says how their V become one")
    return complaints


def manual_pages(tree):
    """A part's page begins with front matter: title, authors, year, key, stage; key and stage are right."""
    complaints = []
    known = tree.bibliography()
    for stage, folder, files in tree.parts():
        name = f"shadow/{stage}/{folder}/{folder}.md"
        if f"{folder}.md" not in files:
            continue
        matter = re.match(r"---\n(.*?)\n---\n", tree.text(name), re.S)
        fields = dict(re.findall(r"^(\w+):\s*(.*?)\s*$", matter[1], re.M)) if matter else {}
        complaints += [f"{name}: the front matter lacks '{field}'"
                       for field in ("title", "authors", "year", "key", "stage") if not fields.get(field)]
        if fields.get("stage", stage) != stage:
            complaints.append(f"{name}: says stage {fields['stage']}, stands in {stage}")
        complaints += [f"{name}: key {key} is not in docs/references.bib"
                       for key in re.findall(r"[^\s,;]+", fields.get("key", "")) if key not in known]
    return complaints


def mutants(tree):
    """A wrong edit still finds its text, once, and its test is there; tools/mutants runs them."""
    complaints = []
    for name in tree.having({".toml"}, "tests/mutants/"):
        for number, mutant in enumerate(tomllib.loads(tree.text(name)).get("mutant", []), 1):
            count = tree.text(mutant["file"]).count(mutant["before"]) if mutant["file"] in tree.files else 0
            if count != 1:
                complaints.append(f"{name}: edit {number} ({mutant['law']}) finds its text {count} times in {mutant['file']}")
            if mutant["test"] not in tree.files:
                complaints.append(f"{name}: edit {number} ({mutant['law']}) names {mutant['test']}, which is not there")
    return complaints


ALL = (part_shape, part_definitions, unnamed_names, one_definition, layering, parts_are_strangers, stages_are_strangers, includes_resolve, folder_names, file_sizes,
       licence_lines, citations, keys_exist, chained_matrices, machine_paths, pages_exist, issue_numbers, portable_glsl, long_shader_texts, named_bindings, recipes, manual_pages, mutants)
