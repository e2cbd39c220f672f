"""The repository stands on its own: no file names a place of somebody's machine, and what pages name is there."""
import re
import sys
from pathlib import Path

from sources import finish, list_files

FOREIGN = re.compile(r"/(?:work|home|root|Users)/\w|shared[/]data|[^/\w]\.\./shared/")
BINARY = {".png", ".exr", ".hdr", ".tif", ".tiff", ".jpg", ".glb", ".fbx", ".bin"}
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
PATH = re.compile(r"`((?:include|src|apps|tests|fuzz|cmake|tools|docs|python|blender|examples)/[\w./-]+\.\w+)`")
SOURCE = re.compile(r"`([\w./-]+\.(?:cpp|h|glsl|comp|vert|frag|cmake|py))`")
MADE = {"relief/version.h"}  # by the build

root = Path(sys.argv[1])
faults = []
files = list_files(root)
tails = MADE | {"/".join(file.parts[k:]) for file in files for k in range(len(file.parts))}
for file in files:
    if file.suffix in BINARY or "corpus" in file.parts:
        continue
    for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
        found = FOREIGN.search(line)
        if found:
            faults.append(f"{file}:{number}: {found.group()}")
        if file.suffix != ".md":
            continue
        named = [file.parent / link for link in LINK.findall(line) if "://" not in link]
        named += [root / path for path in PATH.findall(line) if "NAME" not in path]
        faults += [f"{file}:{number}: there is no {path}" for path in named if not path.exists()]
        faults += [f"{file}:{number}: no source is called {name}" for name in SOURCE.findall(line)
                   if "NAME" not in name and name not in tails]
finish(faults)
