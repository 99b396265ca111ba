# SPDX-License-Identifier: MIT
"""What a configured folder compiles, and how. Imported by tools/check_tidy and tools/mutants."""
import json
import pathlib
import re


def units_of(folder, root):
    """Each compiled file below the root, with its command and the sources that it stands for: itself, or those that it includes
    where neighbours compile as one (cmake/together.cmake). Paths are relative to the root."""
    units = {}
    for entry in json.loads((pathlib.Path(folder) / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if path.is_relative_to(root):
            found = re.findall(r'#include "([^"]+)"', path.read_text()) if "/Unity/" in entry["file"] else [path]
            sources = [str(pathlib.Path(source).relative_to(root)) for source in found if pathlib.Path(source).is_relative_to(root)]
            units[str(path.relative_to(root))] = (entry["command"], sources)
    return units
