#!/bin/sh
# make_python_build.sh FOLDER: an environment with what the Python module is built and tested with. Prints the options that
# CMake needs for it; where the package index cannot be reached, those that leave the module out.
set -eu

folder=$1
python=$folder/bin/python
if ! [ -e "$folder/complete" ]; then
    if ! { python3 -m venv "$folder" &&
        "$python" -m pip install -q --disable-pip-version-check 'nanobind>=2.4' 'numpy>=1.23' 'scikit-build-core>=0.10' &&
        { "$python" -m pip install -q --disable-pip-version-check mypy matplotlib || true; }; } >&2; then
        echo "The Python module is left out: its tools cannot be had from the package index." >&2
        echo "-DRELIEF_PYTHON=OFF"
        exit 0
    fi
    touch "$folder/complete"
fi
echo "-DRELIEF_PYTHON=ON -DPython_EXECUTABLE=$(realpath -s "$python")"
