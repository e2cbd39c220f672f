"""Random events for so long: soak.py RELIEF SECONDS [SEED]. Prints what memory did; not run by ctest.

Drags with all buttons, keys, strokes, undo, scales, views and sizes of brushes, in the window under Xvfb. The viewer must end
by itself with exit code 0, and its memory must not grow by more than 5 % from the first third to the end.
"""
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

from window_test import start_display

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
        lambda: {"set": {"view": dice.choice(["colour", "normal", "depth", "uv", "object", "cost"])}},
        lambda: {"set": {"tool": dice.choice(["look", "push", "grab", "smooth", "erase"]), "radius": dice.randrange(2, 60)}},
        lambda: {"wait": "picture"},
        lambda: {"wait": round(dice.uniform(0, 0.3), 2)},
        lambda: {"key": "."},
    ]
    return [dice.choice(makers)() for _ in range(count)]


def read_resident(process):
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    return 0


def main():
    relief, seconds = os.path.abspath(sys.argv[1]), float(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    server, display = start_display()
    try:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([relief, "scene", "ear", "-o", "ear", "-q"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            lines = [{"wait": "done"}, *make_lines(random.Random(seed), int(seconds * 4)), {"quit": True}]
            pathlib.Path(folder, "soak.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
            viewer = subprocess.Popen([relief, "view", "ear/scene.json", "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp", "16",
                                       "--script", "soak.jsonl"], cwd=folder, stdout=subprocess.DEVNULL,
                                      env={**os.environ, "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"})
            start, resident = time.monotonic(), []
            while viewer.poll() is None:
                try:
                    resident.append(read_resident(viewer))
                except (FileNotFoundError, ProcessLookupError):
                    break
                time.sleep(0.5)
            took = time.monotonic() - start
            third = max(len(resident) // 3, 1)
            early, late = statistics.median(resident[third // 2:third + 1]), statistics.median(resident[-third:])
            print(f"{len(lines)} lines in {took:.0f} s, exit {viewer.wait()}, {early:.0f} MiB, then {late:.0f} MiB")
            assert viewer.returncode == 0
            assert late < 1.05 * early, "memory grew"
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    main()
