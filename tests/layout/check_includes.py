"""Nothing points back: checks every #include of a file against what its folder may know."""
import pathlib
import re
import sys

from sources import INCLUDE, finish, list_code

# What a folder of src/ may include besides itself and include/relief; what these may include is allowed with them.
ALLOWED = {
    "base": [],
    "math": ["base"],
    "formulas": ["math"],
    "path": ["formulas"],
    "image": ["math"],
    "film": ["image"],
    "denoise": ["image"],
    "scene": ["image"],
    "samples": ["scene"],
    "io": ["scene", "formulas"],
    "surface": ["scene", "formulas"],
    "analysis": ["surface"],
    "bvh": ["formulas"],
    "prepare": ["analysis", "bvh"],
    "engine": ["prepare", "film"],
    "cpu": ["engine", "path"],
    "vulkan": ["engine", "path"],
    "lab": ["cpu", "vulkan", "samples"],
    "api": ["lab"],
    "convert": ["prepare"],
    "inspect": ["api", "convert"],
}

# What an application may include of src/ besides include/relief.
PYTHON = ["base", "math"]  # the same for python/src, which has the reports of apps as well
APPS = {"common": ["base"], "bench": ["base", "lab"], "gpu": ["lab"], "cli": ["base", "lab"], "farm": ["base"], "viewer": ["base"]}

# Libraries that only these folders may see; a folder stands for all below it. Tests may see all of them.
LIBRARIES = {
    r"(oneapi/)?tbb/": ["src/base"],
    r"opensubdiv/": ["src/surface"],
    r"xxhash\.h": ["src/base"],
    r"hwy/": ["src/math", "src/formulas", "src/surface", "src/cpu"],
    r"OpenImageIO/|OpenColorIO/": ["src/io/picture/module"],
    r"Imath/|OpenEXR/|png\.h|tiffio\.h|jpeglib\.h|jerror\.h": ["src/io"],
    r"assimp/|draco/|meshoptimizer\.h": ["src/io"],
    r"nlohmann/": ["src/io", "apps/common/report_files.cpp"],
    r"CLI/": ["apps"],
    r"embree3/": ["apps/bench"],
    r"GLFW/|imgui|stb_": ["apps/viewer"],
    r"fmt/": ["src", "apps", "python/src"],
    r"vulkan/vulkan": ["src/vulkan", "src/lab/vulkan"],
    r"nanobind/": ["python/src"],
    r"immintrin\.h|.*mmintrin\.h|arm_neon\.h": [],
}

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
        # The version's header is made from a template.
        is_there = (root / "include" / name).is_file() or (root / "cmake" / f"{parts[-1]}.in").is_file()
        return None if is_there else "there is no such file"
    if place.parts[0] == "apps" and parts[0] in APPS.get(place.parts[1], []):
        return None if (root / "src" / name).is_file() else "there is no such file"
    if place.parts[0] == "apps":
        here = [file.parent, root / "apps", root / "apps" / place.parts[1]]
        return None if any((p / name).is_file() for p in here) else "applications include relief/ and their own files only"
    if place.parts[0] == "python":
        here = [file.parent, root / "apps", *([root / "src"] if parts[0] in PYTHON else [])]
        return None if any((p / name).is_file() for p in here) else "the Python module includes relief/, base/, math/ and reports"
    if place.parts[0] != "src":
        return None
    if name == "kernel_isas.h":  # made by cmake/Kernels.cmake
        return None
    if not (root / "src" / name).is_file():
        return 'write "folder/file.h", as seen from src/'
    if len(place.parts) == 2:
        return "no file lies in src/ itself"
    module, other = place.parts[1], parts[0]
    if module not in reachable or other not in reachable:
        return f"tests/layout/check_includes.py does not know the folder {module if module not in reachable else other}"
    if other not in reachable[module]:
        return f"{module}/ may not include {other}/"
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


def find_cycle(graph):
    """Folders that include one another in a ring, or None."""
    done = set()

    def visit(folder, way):
        if folder in way:
            return way[way.index(folder):] + [folder]
        if folder in done:
            return None
        for other in sorted(graph.get(folder, {})):
            cycle = visit(other, way + [folder])
            if cycle:
                return cycle
        done.add(folder)
        return None

    return next(filter(None, (visit(folder, []) for folder in sorted(graph))), None)


def main():
    root = pathlib.Path(sys.argv[1])
    reachable = close(ALLOWED)
    faults = []
    includes = 0
    graph = {}
    for file in list_code(root):
        for bracket, name in INCLUDE.findall(file.read_text()):
            includes += 1
            place, folder = file.relative_to(root).parts, name.split("/")[0]
            if place[0] == "src" and bracket == '"' and folder in ALLOWED and folder != place[1]:
                edges = graph.setdefault(place[1], {})
                edges[folder] = edges.get(folder, 0) + 1
            fault = check_library_include(root, file, name) if bracket == "<" else check_own_include(root, file, name, reachable)
            if fault:
                faults.append(f"{file.relative_to(root)} includes {name}: {fault}")
    for folder, edges in sorted(graph.items()):
        print(folder, "->", " ".join(f"{other}[{count}]" for other, count in sorted(edges.items())))
    cycle = find_cycle(graph)
    if cycle:
        faults.append("folders include one another: " + " -> ".join(cycle))
    if includes == 0:
        faults.append("no includes found: is the root right?")
    finish(faults)


main()
