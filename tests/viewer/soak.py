"""Random events for about so long: soak.py RELIEF SECONDS [SEED]. Prints what memory did.

Drags and clicks with all buttons, keys, strokes, undo, scales, views and sizes of brushes, in the window under Xvfb. The viewer
must end by itself with exit code 0, show every picture that is waited for within ten seconds, and in a run of a minute or more
its memory must not grow by more than 5 % from the first third to the end.
"""
import json
import os
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from small_scene import write_small_scene
from window_test import SKIPPED, start_display

PATIENCE = 10
LIMIT = 300  # seconds, beyond four times those asked for
SIZE = (320, 180)


def make_lines(dice, count):
    def place():
        return [dice.randrange(SIZE[0]), dice.randrange(SIZE[1])]

    def modifiers():
        return [word for word in ("shift", "control", "alt") if dice.random() < 0.15]

    makers = [
        lambda: {"drag": dice.choice(["left", "middle", "right"]), "from": place(), "to": place(),
                 "seconds": round(dice.uniform(0, 0.6), 2), "modifiers": modifiers()},
        lambda: {"key": dice.choice(["left", "right", "up", "down", "+", "-", ".", "b", "[", "]", "f1", "escape", "1"])},
        lambda: {"key": dice.choice("ZY"), "modifiers": ["control"]},
        lambda: {"scroll": dice.choice([-2, -1, 1, 2]), "at": place()},
        lambda: {"set": {"scale": round(dice.uniform(0.2, 2), 2)}},
        lambda: {"set": {"view": dice.choice(["colour", "normal", "depth", "uv", "object", "cost", "samples"])}},
        lambda: {"set": {"tool": dice.choice(["look", "push", "grab", "smooth", "erase"]), "radius": dice.randrange(2, 60)}},
        lambda: {"wait": "picture"},
        lambda: {"wait": round(dice.uniform(0, 0.3), 2)},
        lambda: {"key": "."},
    ]
    lines = []
    for _ in range(count):
        if dice.random() < 0.05:  # a click
            at = place()
            lines += [{"press": "left", "at": at}, {"release": "left", "at": at}]
        else:
            lines.append(dice.choice(makers)())
    return lines


def read_resident(process):
    """MiB; 0 where the process has ended."""
    try:
        lines = pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines()
    except (FileNotFoundError, ProcessLookupError):
        return 0
    return next((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS")), 0)


def watch(process, limit):
    """Waits for the end, at most for so many seconds: how long that took, and the memory on the way."""
    start, resident = time.monotonic(), [read_resident(process)]
    try:
        while process.poll() is None and time.monotonic() - start < limit:
            time.sleep(0.5)
            resident.append(read_resident(process) or resident[-1])
    finally:
        process.kill()
        process.wait()
    return time.monotonic() - start, resident


def soak(relief, seconds, seed, display, folder):
    write_small_scene(folder)
    lines = [{"wait": "done"}, *make_lines(random.Random(seed), int(seconds * 15)), {"wait": "done"}, {"quit": True}]
    pathlib.Path(folder, "soak.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    with open(pathlib.Path(folder, "times.jsonl"), "w+") as times:
        viewer = subprocess.Popen([relief, "view", "scene.json", "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp", "16",
                                   "--script", "soak.jsonl"], cwd=folder, stdout=times,
                                  env={**os.environ, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"})
        took, resident = watch(viewer, LIMIT + 4 * seconds)
        assert viewer.returncode == 0, f"exit code {viewer.returncode} after {took:.0f} s"
        times.seek(0)
        waits = [step["waited_s"] for step in map(json.loads, times) if "waited_s" in step]
    third = max(len(resident) // 3, 1)
    early, late = statistics.median(resident[third // 2:third + 1]), statistics.median(resident[-third:])
    print(f"{len(lines)} lines in {took:.0f} s, longest wait {max(waits):.2f} s, "
          f"{early:.0f} MiB, then {late:.0f} MiB")
    assert max(waits) < PATIENCE, "a picture did not come"
    assert seconds < 60 or late < 1.05 * early, "memory grew"


def main():
    if not shutil.which("Xvfb"):
        print("no Xvfb: not run")
        raise SystemExit(SKIPPED)
    relief, seconds = os.path.abspath(sys.argv[1]), float(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    server, display = start_display()
    try:
        with tempfile.TemporaryDirectory() as folder:
            soak(relief, seconds, seed, display, folder)
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
