#!/bin/sh
# Builds the library in all its forms, installs each into an empty prefix and builds the examples against it:
# static, shared, and without Vulkan and file readers. tools/check_package.sh [JOBS]
set -eu
cd "$(dirname "$0")/.."
jobs=${1:-$(tools/count_jobs.sh)}

# check NAME OPTIONS...
check() {
    build=build/package/$1
    shift
    cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release -DRELIEF_APPS=OFF "$@"
    cmake --build "$build" -j "$jobs"
    python3 tests/package/check_install.py . "$build" clang++
}

check slim -DRELIEF_VULKAN=OFF -DRELIEF_IO=OFF
check static
check shared -DBUILD_SHARED_LIBS=ON
echo "All forms of the library can be installed and used."
