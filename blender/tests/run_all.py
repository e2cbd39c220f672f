"""Runs the tests of the Blender add-on, each file in a process of its own: run_all.py FOLDER_OF_MODULE [FILE...].

FOLDER_OF_MODULE holds the Python package `relief`, or its wheel. Exit 77, skipped, where there is none for this Python."""
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

SKIPPED = 77
HERE = pathlib.Path(__file__).resolve().parent


def unpack(module, folder):
    """The folder to import from."""
    if module.suffix != ".whl":
        return module
    with zipfile.ZipFile(module) as archive:
        archive.extractall(folder)
    return pathlib.Path(folder)


def main():
    names = sys.argv[2:] or sorted(file.name for file in HERE.glob("test_*.py"))
    with tempfile.TemporaryDirectory() as folder:
        path = unpack(pathlib.Path(sys.argv[1]), folder)
        environment = dict(os.environ, PYTHONPATH=str(path))
        imported = subprocess.run([sys.executable, "-c", "import relief"], env=environment, capture_output=True, text=True)
        if imported.returncode != 0:
            print(f"skipped: the Python module relief is not in {path}: {imported.stderr.strip().splitlines()[-1]}")
            return SKIPPED
        failed = [name for name in names
                  if subprocess.run([sys.executable, str(HERE / name)], env=environment).returncode != 0]
    print("failed: " + " ".join(failed) if failed else f"{len(names)} files of tests passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
