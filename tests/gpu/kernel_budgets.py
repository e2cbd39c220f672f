"""No kernel takes more of a GPU than tests/gpu/kernel_budgets.txt grants it.

kernel_budgets.py RELIEF_GPU [BUDGETS]: compiles all kernels by Mesa's RADV for GPUs that need not be there.
kernel_budgets.py RELIEF_GPU --print:   what is above its goal today, as lines for that file.
"""
import fnmatch
import json
import os
import pathlib
import re
import subprocess
import sys

DEVICES = ["navi21", "gfx1100"]
KEYS = ["registers", "spills", "scratch_bytes"]
COMPILER = "Mesa 22.3."  # of Debian 12: another one has other figures
FOLDERS = ["/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/usr/share/vulkan/icd.d"]
SKIPPED = 77
SHARED_BYTES = 16384  # of a group: what every device has (maxComputeSharedMemorySize)


def skip(reason):
    print(f"skipped: {reason}")
    raise SystemExit(SKIPPED)


def list_kernels(program, device):
    drivers = [str(file) for folder in FOLDERS for file in pathlib.Path(folder).glob("radeon_icd*.json")]
    if not drivers:
        skip("there is no radeon_icd*.json (package mesa-vulkan-drivers)")
    environment = os.environ | {"VK_DRIVER_FILES": drivers[0], "VK_ICD_FILENAMES": drivers[0], "RADV_FORCE_FAMILY": device}
    done = subprocess.run([program, "kernels", "--json"], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    if COMPILER not in result["driver"]:
        skip(f"budgets are for {COMPILER}x, this is {result['driver']}")
    assert len(result["kernels"]) > 100, "some kernels are not listed"
    return result["kernels"]


def read_budgets(text):
    """Lines of (kernel, case, {device: figures}); those of a kernel that come later count."""
    budgets = []
    for line in text.splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        kernel, case, *figures, reason = [part.strip() for part in line.split("|")]
        assert len(figures) == len(DEVICES) and reason, line
        budgets.append((kernel, case, {device: [int(n) for n in figure.split()] for device, figure in zip(DEVICES, figures)}))
    return budgets


def is_for(budget, row):
    return fnmatch.fnmatchcase(row["kernel"], budget[0]) and fnmatch.fnmatchcase(row["cases"][0], budget[1])


def measure(row):
    return [row[key] for key in KEYS]


def find_faults(rows, budgets, device):
    faults = []
    for row in rows:
        limits = [budget for budget in budgets if is_for(budget, row)][-1][2][device]
        faults += [f"{row['kernel']} ({row['cases'][0]}, {row['program']}) on {device}: {key} {value}, its budget is {limit}"
                   for key, value, limit in zip(KEYS, measure(row), limits) if value > limit]
        if row["program"] == "Compute Shader" and row["shared_bytes"] > SHARED_BYTES:
            faults.append(f"{row['kernel']} ({row['cases'][0]}) on {device}: shared_bytes {row['shared_bytes']}")
    return faults


def find_unused(rows, budgets):
    return [f"no kernel is {budget[0]} in the case {budget[1]}" for budget in budgets if not any(is_for(budget, row) for row in rows)]


def print_lines(lists, goals):
    """For each kernel above its goal a line, and one more of its plainest case where that needs less."""
    names = list(dict.fromkeys(row["kernel"] for row in lists[DEVICES[0]]))
    for name in names:
        rows = {device: [row for row in lists[device] if row["kernel"] == name] for device in DEVICES}
        if not any(find_faults(rows[device], goals, device) for device in DEVICES):
            continue
        plain = rows[DEVICES[0]][0]["cases"][0]
        kinds = {"*": rows, plain: {device: [row for row in rows[device] if row["cases"][0] == plain] for device in DEVICES}}
        lines = {}
        for case, chosen in kinds.items():
            most = {device: [max(values) for values in zip(*map(measure, chosen[device]))] for device in DEVICES}
            lines.setdefault(tuple(map(tuple, most.values())), case)
        for figures, case in lines.items():
            print(f"{name} | {case} | " + " | ".join(" ".join(map(str, f)) for f in figures) + " | ")


def main():
    program = sys.argv[1]
    file = pathlib.Path(__file__).parent / "kernel_budgets.txt"
    if sys.argv[2:] and sys.argv[2] != "--print":
        file = pathlib.Path(sys.argv[2])
    text = file.read_text()
    budgets = read_budgets(text)
    lists = {device: list_kernels(program, device) for device in DEVICES}
    if "--print" in sys.argv:
        return print_lines(lists, read_budgets(text[:text.index("# above the goals")]))
    faults = find_unused(lists[DEVICES[0]], budgets)
    for device, rows in lists.items():
        faults += find_faults(rows, budgets, device)
        # One register more than the most of any kernel, for a kernel of the plainest scene, does not pass.
        fat = rows[0] | {"registers": 1 + max(row["registers"] for row in rows)}
        assert find_faults([fat], budgets, device), "a fat kernel passes"
    for fault in faults:
        print(fault)
    print(f"{sum(map(len, lists.values()))} kernels, {len(faults)} faults")
    raise SystemExit(1 if faults else 0)


main()
