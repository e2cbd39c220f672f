#!/bin/sh
# The documentation as a site in build/docs, by mkdocs-material in a virtual environment of its own.
set -eu
cd "$(dirname "$0")/.."
environment=build/docs-environment
if [ ! -e "$environment/complete" ]; then
    python3 -m venv "$environment"
    "$environment/bin/pip" install -q --disable-pip-version-check 'mkdocs-material==9.*'
    touch "$environment/complete"
fi
rm -rf build/docs-pages
mkdir -p build/docs-pages/docs
cp ./*.md LICENSE build/docs-pages/
cp -r docs/. build/docs-pages/docs/
"$environment/bin/mkdocs" build --strict -q
echo "build/docs/index.html"
