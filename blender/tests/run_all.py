"""Runs the tests of the Blender add-on, each file in a process of its own: run_all.py FOLDER [test_NAME.py...].

FOLDER holds wheels of the Python module, as `make wheel` writes them. Exit 77, skipped, where none is for this Python."""
import os
import pathlib
import subprocess
import sys
import tempfile
import zipfile

SKIPPED = 77
HERE = pathlib.Path(__file__).resolve().parent


def find_module(folder, unpacked):
    """A folder from which `relief` can be imported, or None."""
    for wheel in sorted(folder.glob("relief-*.whl"), key=os.path.getmtime, reverse=True):
        target = pathlib.Path(unpacked) / wheel.stem
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(target)
        command = [sys.executable, "-c", "import relief"]
        if subprocess.run(command, env=dict(os.environ, PYTHONPATH=str(target)), capture_output=True).returncode == 0:
            return target
    return None


def main():
    folder = pathlib.Path(sys.argv[1])
    names = sys.argv[2:] or sorted(file.name for file in HERE.glob("test_*.py"))
    with tempfile.TemporaryDirectory() as unpacked:
        module = find_module(folder, unpacked)
        if module is None:
            print(f"skipped: no wheel in {folder} is for Python {sys.version_info[0]}.{sys.version_info[1]}: make wheel")
            return SKIPPED
        environment = dict(os.environ, PYTHONPATH=str(module))
        failed = [name for name in names
                  if subprocess.run([sys.executable, str(HERE / name)], env=environment).returncode != 0]
    print("failed: " + " ".join(failed) if failed else f"{len(names)} files of tests passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
