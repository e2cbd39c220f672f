#!/bin/sh
# run_fuzzers.sh BUILD SECONDS: runs every fuzzer of a build for SECONDS each. New inputs go to BUILD/fuzz/corpus,
# crashes to BUILD/fuzz; the corpus of the repository is only read.
set -eu

build=$1
seconds=$2
root=$(dirname "$0")/..
export LSAN_OPTIONS="suppressions=$root/tools/lsan.supp:print_suppressions=0"
for fuzzer in "$build"/bin/*_fuzzer; do
    name=$(basename "$fuzzer" _fuzzer)
    mkdir -p "$build/fuzz/corpus/$name"
    echo "$name: $seconds s"
    "$fuzzer" "$build/fuzz/corpus/$name" "$root/fuzz/corpus/$name" -max_total_time="$seconds" -timeout=20 \
        -rss_limit_mb=2048 -artifact_prefix="$build/fuzz/$name-" -print_final_stats=1
done
