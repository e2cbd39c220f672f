#!/bin/sh
# install_python.sh FOLDER: an environment of Python with the module `relief`, built from this clone.
set -eu

folder=$1
[ -e "$folder/bin/python" ] || python3 -m venv "$folder"
"$folder/bin/python" -m pip install -q --disable-pip-version-check --upgrade .
"$folder/bin/python" -c 'import relief; print("relief", relief.__version__, "is in", relief.__file__)'
