#!/bin/sh
# report_coverage.sh BUILD JOBS: runs the tests of a coverage build and writes BUILD/report.txt, line coverage a file.
set -eu

build=$(cd "$1" && pwd)
jobs=$2
rm -rf "$build/profiles"
mkdir -p "$build/profiles"
LLVM_PROFILE_FILE="$build/profiles/%p.profraw" ctest --preset coverage -j "$jobs"
llvm-profdata merge -sparse "$build"/profiles/*.profraw -o "$build/tests.profdata"

objects=
for program in "$build"/bin/*_tests "$build"/bin/relief; do
    [ -x "$program" ] && objects="$objects -object $program"
done
# shellcheck disable=SC2086
llvm-cov report $objects -instr-profile="$build/tests.profdata" -ignore-filename-regex='(^|/)(tests|usr|build)/' \
    >"$build/report.txt"
tail -n 1 "$build/report.txt"
echo "Coverage a file: $build/report.txt"
