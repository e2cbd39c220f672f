#!/usr/bin/env python3
"""How long `relief farm status` takes for a large job: measure_farm_status.py RELIEF [FRAMES TILES].

Makes a job folder with the names that tasks leave in it, in the order in which 64 tasks at once would make and rename
them, and times `status` five times. With the right to empty the system's cache (root) it does so before each of five
more runs; the program is in the cache again by then. Prints medians, least and most. The folder is made where temporary
files are (TMPDIR), and removed.
"""
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "viewer"))
from small_scene import write_small_scene  # noqa: E402

AT_ONCE = 64
RUNS = 5
DROP_CACHES = pathlib.Path("/proc/sys/vm/drop_caches")


def end_attempt(start, choose):
    """Renames an attempt as its process would: most are done, a few failed or are lost."""
    fate = choose.random()
    if fate < 0.0001:
        end = "failed.3"
    elif fate < 0.001:
        end = "lost"
    else:
        end = f"done.{choose.randrange(10**6, 10**8)}.{choose.randrange(1000, 90000)}"
    os.rename(f"{start}.running", f"{start}.{end}")


def fill(job, frames, tiles):
    """All attempts but those at the last hundredth of the tasks; the last 64 still run."""
    choose, running = random.Random(29), []
    for task in range(frames * tiles * 99 // 100):
        folder = job / "state" / f"{task // 1000:06}"
        if task % 1000 == 0:
            folder.mkdir()
        start = f"{folder}/{task}.node{choose.randrange(40):03}-{choose.randrange(4194304)}-{1764000000000000 + task * 50000}"
        os.close(os.open(f"{start}.running", os.O_CREAT | os.O_WRONLY))
        running.append(start)
        if len(running) > AT_ONCE:
            end_attempt(running.pop(choose.randrange(AT_ONCE)), choose)
    (job / "written").mkdir()
    for frame in range(1, max(1, frames * 98 // 100)):
        (job / "written" / str(frame)).touch()


def measure(relief, job, prepare):
    """Seconds of each run."""
    times = []
    for _ in range(RUNS):
        prepare()
        subprocess.run([relief, "--help"], check=True, stdout=subprocess.DEVNULL)
        start = time.monotonic()
        subprocess.run([relief, "farm", "status", job], check=True, stdout=subprocess.DEVNULL)
        times.append(time.monotonic() - start)
    return times


def empty_cache():
    os.sync()
    DROP_CACHES.write_text("3")


def main():
    relief = sys.argv[1]
    frames, tiles = map(int, sys.argv[2:4]) if len(sys.argv) > 3 else (10000, 64)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_small_scene(folder)
        subprocess.run([relief, "farm", "plan", folder / "scene.json", "--frames", f"1-{frames}", "--tiles", str(tiles),
                        "--size", "160x90", "--spp", "1", "-o", folder / "job", "-q"], check=True)
        fill(folder / "job", frames, tiles)
        kinds = [("cached", lambda: None)] + ([("not cached", empty_cache)] if os.access(DROP_CACHES, os.W_OK) else [])
        for kind, prepare in kinds:
            times = measure(relief, folder / "job", prepare)
            print(f"status, names {kind}: {statistics.median(times):.2f} s ({min(times):.2f} to {max(times):.2f})", flush=True)


if __name__ == "__main__":
    main()
