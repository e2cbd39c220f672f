"""Nothing points back: checks every #include of a file against what its folder may know."""
import pathlib
import re
import sys

from sources import INCLUDE, finish, list_code

# What a folder of src/ may include besides itself and include/relief; what these may include is allowed with them.
# "" stands for the files directly in src/.
ALLOWED = {
    "base": [],
    "shared": [],
    "math": ["base", "shared"],
    "image": ["base", "math"],
    "scene": ["image", "math"],
    "io": ["scene", "image"],
    "surface": ["scene"],
    "structures": ["math"],
    "film": ["image"],
    "samples": ["scene", "math"],
    "engine": ["scene", "surface", "structures", "film", "image", "math", "base"],
    "": ["engine", "samples"],
}

# Libraries that only these folders may see; a folder stands for all below it. Tests may see all of them.
LIBRARIES = {
    r"(oneapi/)?tbb/": ["src/base"],
    r"opensubdiv/": ["src/surface"],
    r"hwy/": ["src/math", "src/surface", "src/engine/cpu"],
    r"OpenImageIO/": ["src/io/pictures"],
    r"Imath/|OpenEXR/|zlib\.h": ["src/io"],
    r"tiny_obj_loader\.h": ["src/io"],
    r"assimp/": ["src/io"],
    r"nlohmann/": ["src/io", "apps"],
    r"CLI/": ["apps"],
    r"embree3/": ["apps/bench"],
    r"fmt/": ["src", "apps"],
    r"vulkan/": ["src/engine/vulkan"],
    r"immintrin\.h|.*mmintrin\.h|arm_neon\.h": [],
}

# Never in one another, although both are in src/engine.
APART = [("engine/cpu", "engine/vulkan")]


def close(table):
    """The transitive closure of the table, each folder with itself."""
    def reach(folder, seen):
        if folder not in seen:
            seen.add(folder)
            for other in table[folder]:
                reach(other, seen)
        return seen
    return {folder: reach(folder, set()) for folder in table}


def check_own_include(root, file, name, reachable):
    """The fault of a quoted include, or None."""
    place = file.relative_to(root)
    parts = pathlib.PurePosixPath(name).parts
    if place.parts[0] == "include":
        return None if parts[0] == "relief" else "the public headers include relief/ and the standard library only"
    if parts[0] == "relief":
        return None if (root / "include" / name).is_file() else "there is no such file"
    if place.parts[0] == "apps":
        here = [file.parent, root / "apps", root / "apps" / place.parts[1]]
        return None if any((p / name).is_file() for p in here) else "applications include relief/ and their own files only"
    if place.parts[0] != "src":
        return None
    if not (root / "src" / name).is_file():
        return 'write "folder/file.h", as seen from src/'
    module = place.parts[1] if len(place.parts) > 2 else ""
    other = parts[0] if len(parts) > 1 else ""
    if module not in reachable or other not in reachable:
        return f"tests/layout/check_includes.py does not know the folder {module if module not in reachable else other}"
    if other not in reachable[module]:
        return f"{module or 'src'}/ may not include {other or 'src'}/"
    for one, two in APART:
        for a, b in ((one, two), (two, one)):
            if str(place).startswith(f"src/{a}/") and name.startswith(f"{b}/"):
                return f"{a} and {b} stay apart"
    return None


def check_library_include(root, file, name):
    """The fault of an include in angle brackets, or None."""
    place = file.relative_to(root)
    if place.parts[0] == "include":
        return None if re.fullmatch(r"[a-z_0-9]+", name) else "the public headers include relief/ and the standard library only"
    if place.parts[0] == "tests":
        return None
    for pattern, folders in LIBRARIES.items():
        if re.match(pattern, name) and not any(place.is_relative_to(f) for f in folders):
            return f"only in {', '.join(folders)}" if folders else "instruction sets are reached through Highway only"
    return None


def main():
    root = pathlib.Path(sys.argv[1])
    reachable = close(ALLOWED)
    faults = []
    includes = 0
    for file in list_code(root):
        for bracket, name in INCLUDE.findall(file.read_text()):
            includes += 1
            fault = check_library_include(root, file, name) if bracket == "<" else check_own_include(root, file, name, reachable)
            if fault:
                faults.append(f"{file.relative_to(root)} includes {name}: {fault}")
    if includes == 0:
        faults.append("no includes found: is the root right?")
    finish(faults)


main()
