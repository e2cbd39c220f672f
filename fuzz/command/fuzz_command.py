#!/usr/bin/env python3
"""fuzz_command.py PROGRAM [--count N] [--budget S] [--seed N] [--keep DIR]: mutated files of all formats through `inspect`
and a small `render`, with limits of time and memory. Fails for a signal, an exit code that is not for bad input, a refusal
without a message, or a run that takes too long. File k of a seed is always the same; --budget ends early."""
import argparse
import collections
import multiprocessing
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # nothing is to lie about in the folder of sources
import mutations
import seeds

LIMIT_S = 10
MEMORY_BYTES = 2 << 30
# Done, usage, bad input, out of memory, warnings under --strict: all that a file may bring about.
EXIT_CODES = {0, 2, 3, 5, 6}
SMALL = ["--size", "16x12", "--spp", "1", "--bounces", "1", "--threads", "1", "-o", "out.png"]


def list_commands(suffix, name):
    if suffix in (".obj", ".ply", ".gltf", ".glb", ".fbx", ".json"):
        return [["inspect", name], ["render", name, *SMALL]]
    if suffix == ".hdr":
        return [["inspect", name], ["render", "good.obj", "--env", name, *SMALL]]
    return [["inspect", name], ["render", "good.obj", "--vdm", name, "--space", "tangent", *SMALL]]


def set_limits():
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(program, words, folder):
    """Exit code, output and seconds; no code where it ran out of time."""
    start = time.monotonic()
    try:
        done = subprocess.run([program, *words], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL,
                              timeout=LIMIT_S, preexec_fn=set_limits)
    except subprocess.TimeoutExpired:
        return None, b"", time.monotonic() - start
    return done.returncode, done.stdout + done.stderr, time.monotonic() - start


def find_fault(program, words, folder):
    code, output, seconds = run(program, words, folder)
    if code is None:  # once more: the machine may have been busy
        code, output, seconds = run(program, words, folder)
    if code is None:
        return f"not done after {LIMIT_S} s", code, seconds
    if code < 0:
        return f"signal {-code}", code, seconds
    text = output.decode(errors="replace")
    if code not in EXIT_CODES:
        return f"exit {code}: {text[-400:]}", code, seconds
    if code != 0 and "error" not in text:
        return f"exit {code} without a message", code, seconds
    return None, code, seconds


def try_file(job):
    """Writes mutated file `number` and runs the commands on it; returns its faults and what was run."""
    program, keep, seed, number = job
    chance = random.Random(f"{seed} {number}")
    suffix = sorted(try_file.seeds)[number % len(try_file.seeds)]
    data = mutations.mutate(suffix, chance.choice(try_file.seeds[suffix]), chance)
    folder = try_file.folder / str(os.getpid())
    if not folder.exists():
        shutil.copytree(try_file.folder / "good", folder)
    name = f"mutated{suffix}"
    (folder / name).write_bytes(data)
    faults, runs = [], []
    for words in list_commands(suffix, name):
        fault, code, seconds = find_fault(program, words, folder)
        runs.append((suffix, code, seconds))
        if fault:
            kept = keep / f"{seed}-{number}{suffix}"
            shutil.copyfile(folder / name, kept)
            faults.append(f"{kept}: {' '.join(words)}: {fault}")
    return faults, runs


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--budget", type=float, default=float("inf"), help="seconds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("."), help="where files that broke it go")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    arguments.keep.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        try_file.folder = pathlib.Path(folder)
        (try_file.folder / "good").mkdir()
        try_file.seeds = seeds.make_seeds(program, try_file.folder / "good")
        for suffix, files in try_file.seeds.items():  # a seed that is refused would test little
            for data in files:
                (try_file.folder / "good" / f"seed{suffix}").write_bytes(data)
                for words in list_commands(suffix, f"seed{suffix}"):
                    code, output, _ = run(program, words, try_file.folder / "good")
                    if code != 0 and words[0] == "render":
                        sys.exit(f"the seed {suffix} is refused: {output.decode(errors='replace')}")
        jobs = [(program, arguments.keep, arguments.seed, k) for k in range(arguments.count)]
        start, faults, runs, tried = time.monotonic(), [], [], 0
        with multiprocessing.get_context("fork").Pool() as pool:
            for found, ran in pool.imap(try_file, jobs, chunksize=4):
                faults += found
                runs += ran
                tried += 1
                for fault in found:
                    print(fault, flush=True)
                if time.monotonic() - start > arguments.budget:
                    pool.terminate()
                    break
    codes = collections.Counter((suffix, code) for suffix, code, _ in runs)
    print(f"{tried} files, {len(runs)} runs, slowest {max(seconds for *_, seconds in runs):.1f} s, {len(faults)} faults")
    for suffix in sorted({suffix for suffix, _ in codes}):
        print(suffix, {code: n for (kind, code), n in sorted(codes.items(), key=str) if kind == suffix})
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
