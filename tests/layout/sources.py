"""The files of the repository that the layout tests look at."""
import pathlib
import re

FOLDERS = ["include", "examples", "src", "apps", "tests", "fuzz", "bench", "python", "blender", "cmake", "tools", "docs", ".ci"]
CODE = {".h", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
SCRIPTS = {".py", ".sh", ".cmake"}


def list_files(root, folders=None):
    """Sorted paths of all files below the given folders, and of those in the root when no folders are given."""
    root = pathlib.Path(root)
    files = [] if folders else [p for p in root.iterdir() if p.is_file() and p.name != ".git"]
    for folder in folders or FOLDERS:
        files += [p for p in (root / folder).rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return sorted(files)


def list_code(root, folders=("include", "src", "apps", "tests", "fuzz", "bench", "python")):
    return [p for p in list_files(root, folders) if p.suffix in CODE]


def finish(faults):
    """Prints the faults and ends the test."""
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults")
    raise SystemExit(1 if faults else 0)
