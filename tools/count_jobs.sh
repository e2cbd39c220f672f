#!/bin/sh
# Prints how many compilers may run at once: one a core, and one a 1.5 GiB of free memory.
set -eu

cores=$(nproc 2>/dev/null || echo 2)
free_kib=$(sed -n 's/^MemAvailable: *\([0-9]*\) kB$/\1/p' /proc/meminfo 2>/dev/null || true)
by_memory=$((${free_kib:-3145728} / 1572864))
[ "$by_memory" -ge 1 ] || by_memory=1
[ "$cores" -le "$by_memory" ] && echo "$cores" || echo "$by_memory"
