#!/bin/sh
# Tests, parity and measurements of the Vulkan engine on this machine. Needs a Vulkan driver and gzip, nothing else.
#   run.sh [-o RESULT.json] [--parts tests,kernels,parity,bench] [--device N] [--quick] [--parity WORDS] [--bench WORDS]
# WORDS are more options of `relief-gpu parity` or `relief-gpu bench`, e.g. --bench "--scenes bark,party --runs 7".
# RESULT.json (default relief-gpu.json here) tells each part's outcome; logs lie in a folder beside it.
# Exit code: 0 when every part asked for passed, 1 otherwise, 2 for wrong usage.
set -u

here=$(cd "$(dirname "$0")" && pwd)
result=relief-gpu.json
parts=tests,kernels,parity,bench
device=
quick=
parity_words=
bench_words=
while [ $# -gt 0 ]; do
    case $1 in
    -o) result=${2:?-o needs a file} && shift 2 ;;
    --parts) parts=${2:?--parts needs a list} && shift 2 ;;
    --device)
        device="--device ${2:?--device needs a number}" && shift 2
        export RELIEF_TEST_DEVICE="${device#--device }"
        ;;
    --parity) parity_words=${2?--parity needs words} && shift 2 ;;
    --bench) bench_words=${2?--bench needs words} && shift 2 ;;
    --quick) quick=--quick && shift ;;
    *) sed -n '2,6s/^# *//p' "$0" >&2 && exit 2 ;;
    esac
done
for part in $(echo "$parts" | tr , ' '); do
    case $part in
    tests | kernels | parity | bench) ;;
    *) echo "run.sh: unknown part '$part': tests, kernels, parity, bench" >&2 && exit 2 ;;
    esac
done

case $result in /*) ;; *) result=$PWD/$result ;; esac
logs=${result%.json}-files
rm -rf "$logs"
mkdir -p "$logs/lib" "$logs/bin" || exit 1

for packed in "$here"/*.gz; do
    program=$logs/bin/$(basename "$packed" .gz)
    gzip -dc "$packed" >"$program" && chmod +x "$program"
done

# System libraries come first: the driver was built against them.
known=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null)
for library in "$here"/fallback/*; do
    case $known in
    *"$(basename "$library") "*) ;;
    *) ln -s "$library" "$logs/lib/" ;;
    esac
done
export LD_LIBRARY_PATH="$here/lib:$logs/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export VK_LAYER_PATH="$here/layers"

# Containers keep the driver's manifest in places that the loader does not search.
if [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] &&
    ! ls /etc/vulkan/icd.d/*.json /usr/share/vulkan/icd.d/*.json /usr/local/share/vulkan/icd.d/*.json 2>/dev/null |
        grep -q .; then
    for manifest in /usr/local/nvidia/share/vulkan/icd.d/*.json /opt/*/share/vulkan/icd.d/*.json; do
        [ -f "$manifest" ] && export VK_DRIVER_FILES="$manifest" VK_ICD_FILENAMES="$manifest" && break
    done
fi

all_passed=true
entries=

# run_part NAME RESULT_OF_PART COMMAND...
run_part() {
    name=$1 file=$2 && shift 2
    echo "== $name" >&2
    begin=$(date +%s)
    "$@" >"$logs/$name.log" 2>&1
    code=$?
    seconds=$(($(date +%s) - begin))
    outcome=passed
    [ $code -eq 0 ] || { outcome=failed && all_passed=false; }
    tail -n 3 "$logs/$name.log" | sed 's/^/   /' >&2
    echo "   $outcome after $seconds s, log: $logs/$name.log" >&2
    entries="$entries${entries:+,}
  \"$name\": {\"outcome\": \"$outcome\", \"exit_code\": $code, \"seconds\": $seconds, \"result\":
$(if [ -s "$file" ]; then cat "$file"; else echo null; fi)}"
}

# Several processes share the device: most of what tests take is compiling kernels. Each writes a list of its own.
run_tests() {
    jobs=$(nproc 2>/dev/null || echo 1)
    [ "$jobs" -le 14 ] || jobs=14
    pids=
    for shard in $(seq 0 $((jobs - 1))); do
        GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$shard "$logs/bin/vulkan_tests" \
            --gtest_output="json:tests-$shard.json" >"tests-$shard.log" 2>&1 &
        pids="$pids $!"
    done
    failed=0
    for pid in $pids; do wait "$pid" || failed=1; done
    cat tests-*.log
    ls tests-*.json >/dev/null 2>&1 || return 1
    {
        echo '['
        for shard in $(seq 0 $((jobs - 1))); do
            [ "$shard" -eq 0 ] || echo ','
            if [ -s "tests-$shard.json" ]; then cat "tests-$shard.json"; else echo null; fi
        done
        echo ']'
    } >tests.json
    return $failed
}

cd "$logs" || exit 1
"$logs/bin/relief-gpu" devices >devices.json 2>devices.log
for part in $(echo "$parts" | tr , ' '); do
    # $device, $quick and the further words are split into words, or nothing.
    case $part in
    tests) run_part tests tests.json run_tests ;;
    kernels) run_part kernels kernels.json "$logs/bin/relief-gpu" kernels -o kernels.json $device ;;
    parity) run_part parity parity.json "$logs/bin/relief-gpu" parity -o parity.json --pipeline-cache pipelines \
        $device $quick $parity_words ;;
    bench) run_part bench paper1/paper1.json "$logs/bin/relief-gpu" bench -o paper1 --pipeline-cache pipelines \
        $device $quick $bench_words ;;
    esac
done
rm -rf "$logs/lib" "$logs/bin"

{
    echo "{\"commit\": \"$(cat "$here/commit")\", \"all_passed\": $all_passed, \"date\": \"$(date -u +%Y-%m-%dT%H:%MZ)\","
    echo " \"devices\":"
    if [ -s devices.json ]; then cat devices.json; else echo null; fi
    echo " ,\"parts\": {$entries"
    echo "}}"
} >"$result"
echo "The result is $result" >&2
$all_passed
