#!/usr/bin/env python3
"""What a task of a farm costs beside tracing: measure_farm_tasks.py RELIEF SCENE [options]. Made for a quiet machine.

Start, load and prepare are medians; "write and rest" is what `relief farm work` takes beside these and tracing: its film,
its preview and the files of its state. They are measured with one sample a pixel, where tracing is short. Tracing is that
of `relief render --tile --samples --stats`: the mean of bands from the upper, the middle and the lower part of the frame.
Prints the tables of docs/farm.md, and the cuts whose overhead is below a share of the task. The docs have it for

    relief scene party && tools/measure_farm_tasks.py relief party/scene.json --spp 64 --options "--size 1280x720 --bounces 4"
    relief scene shot && tools/measure_farm_tasks.py relief shot/scene.json --frame 12
"""
import argparse
import json
import pathlib
import shlex
import statistics
import subprocess
import tempfile
import time

RUNS = 5


def parse_words():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("relief", help="the program")
    parser.add_argument("scene")
    parser.add_argument("--frame", type=int, default=1)
    parser.add_argument("--spp", type=int, help="default: the scene's")
    parser.add_argument("--options", default="", help="others of relief render, in one word")
    parser.add_argument("--cuts", default="4x1,8x1,8x2,16x1,16x2,32x1", help="tiles x passes; default %(default)s")
    parser.add_argument("--share", type=float, default=0.05, help="of a task that may be overhead; default %(default)s")
    return parser.parse_args()


class Measurement:
    """Of one scene, in a folder for what it writes."""

    def __init__(self, words, folder):
        self.relief, self.scene, self.frame, self.folder = words.relief, words.scene, str(words.frame), folder
        self.options, self.spp = shlex.split(words.options), words.spp

    def run(self, *words):
        """Seconds of wall-clock time."""
        start = time.monotonic()
        subprocess.run([self.relief, *map(str, words)], check=True, stdout=subprocess.DEVNULL)
        return time.monotonic() - start

    def render(self, tile, tiles, *more):
        """Statistics of a band of rows."""
        file = self.folder / "stats.json"
        self.run("render", self.scene, "--frames", self.frame, *self.options, *more, "--tile", f"{tile}/{tiles}", "--stats", file,
                 "-o", self.folder / "band.####.exr", "-q")
        return json.loads(file.read_text())

    def measure_overhead(self, tiles):
        """Seconds by part, of a task that has one band of so many."""
        job, tile = self.folder / f"job{tiles}", tiles // 2
        self.run("farm", "plan", self.scene, "--frames", self.frame, *self.options, "--spp", 1, "--tiles", tiles, "-o", job, "-q")
        start = statistics.median(self.run("--help") for _ in range(RUNS))
        times = [self.render(tile, tiles, "--spp", 1)["time_s"] for _ in range(RUNS)]
        load, prepare, render = (statistics.median(t[part] for t in times) for part in ("load", "prepare", "render"))
        task = statistics.median(self.run("farm", "work", job, "--task", tile, "--again", "--log") for _ in range(RUNS))
        return {"start": start, "load": load, "prepare": prepare, "write and rest": max(0, task - start - load - prepare - render)}

    def count_samples(self):
        """Samples a pixel of the picture."""
        if self.spp:
            return self.spp
        job = self.folder / "whole"
        self.run("farm", "plan", self.scene, "--frames", self.frame, *self.options, "-o", job, "-q")
        return json.loads((job / "job.json").read_text())["spp"]

    def measure_tracing(self, tiles, samples):
        """Seconds of a task, on average."""
        bands = sorted({tiles // 6, tiles // 2, tiles * 5 // 6})
        return statistics.mean(self.render(band, tiles, "--samples", f"0:{samples}")["time_s"]["render"] for band in bands)


def main():
    words = parse_words()
    with tempfile.TemporaryDirectory() as name:
        measurement = Measurement(words, pathlib.Path(name))
        spp, overheads, good = measurement.count_samples(), {}, []
        print("| --tiles | --passes | start | load | prepare | write and rest | trace | overhead |\n|---|---|---|---|---|---|---|---|")
        for cut in words.cuts.split(","):
            tiles, passes = map(int, cut.split("x"))
            if tiles not in overheads:
                overheads[tiles] = measurement.measure_overhead(tiles)
            parts, trace = overheads[tiles], measurement.measure_tracing(tiles, max(1, spp // passes))
            share = sum(parts.values()) / (sum(parts.values()) + trace)
            print(f"| {tiles} | {passes} |", " | ".join(f"{seconds:.3g} s" for seconds in parts.values()),
                  f"| {trace:.3g} s | {100 * share:.2g} % |", flush=True)
            if share < words.share:
                good.append(f"--tiles {tiles} --passes {passes}")
        print(f"\nbelow {100 * words.share:g} %:", "; ".join(good) or "none of these")


if __name__ == "__main__":
    main()
