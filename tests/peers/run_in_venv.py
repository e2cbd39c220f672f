"""Runs a Python script in a virtual environment with a package of the package index and what it lacks.

usage: run_in_venv.py FOLDER PACKAGE SCRIPT ARGUMENTS...

The environment FOLDER/PACKAGE is made when it is missing. Exit 77, which CTest reports as skipped, where the package
cannot be had: no network, no build of it for this Python and machine, or libraries that it needs are missing."""
import os
import pathlib
import subprocess
import sys

SKIPPED = 77
VERSIONS = {"bpy": ["bpy==4.5.15", "bpy==4.2.0"], "cryptomatte_api": ["cryptomatte-api==1.0.0"],
            "mitsuba": ["mitsuba==3.9.1 numpy"], "pyoidn": ["pyoidn==2.5.1.0"], "openjd": ["openjd-cli==0.8.0"]}  # the first that can be had


def install(folder, package):
    python = folder / "bin" / "python"
    marker = folder / "complete"
    if marker.exists():
        return python
    if subprocess.run([sys.executable, "-m", "venv", folder]).returncode != 0:
        return None
    for version in VERSIONS[package]:
        pip = subprocess.run([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", *version.split()])
        if pip.returncode == 0 and subprocess.run([python, "-c", f"import {package}"]).returncode == 0:
            marker.touch()
            return python
    return None


def main():
    folder, package, script = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    python = install(folder / package, package)
    if python is None:
        print(f"skipped: {package} cannot be installed from the package index here")
        return SKIPPED
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run([python, script, *sys.argv[4:]], env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
