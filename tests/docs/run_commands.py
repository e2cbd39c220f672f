"""Runs the commands that README and docs show: run_commands.py ROOT RELIEF.

A render or a bench of a page takes minutes. Each command runs as it is written, but through a `relief` that makes the
pictures small; those of `bench` and `view` are checked for their names and options alone. Files that pages speak of come from the
samples. Lines with brackets are summaries of usage, and are not run."""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import pages

# Pictures of one sample; of farms one frame.
SMALL = """#!/usr/bin/env python3
import os, sys
words = sys.argv[1:]
if words[:1] == ["render"] or words[:2] == ["farm", "plan"]:
    for option, value in (("--size", "48x27"), ("--spp", "1"), ("--bounces", "1")):
        if option in words:
            words[words.index(option) + 1] = value
        elif option != "--spp" or "--samples" not in words:
            words += [option, value]
    if words[0] == "farm":
        words[words.index("--frames") + 1] = "1"
    words.append("-q")
os.execv(%(relief)r, ["relief", *words])
"""
# Only these need more than the samples have.
NEEDS_DEVICE = ("--engine vulkan", "--device", "--to slurm", "--submit slurm")


def run(command: str, folder: pathlib.Path, path: pathlib.Path) -> subprocess.CompletedProcess:
    environment = dict(os.environ, PATH=f"{path}:{os.environ['PATH']}")
    return subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)


def make_files(folder: pathlib.Path, relief: str) -> None:
    """What the pages call by these names."""
    def call(*words: str) -> None:
        subprocess.run([relief, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    call("scene", "ear", "-o", "given")
    for name in ("plane.obj", "cow.obj", "my.obj", "body.obj", "head.obj"):
        shutil.copy(folder / "given/meshes/ear.obj", folder / name)
    for name in ("ear.exr", "hide.exr", "my.exr", "head.exr"):
        shutil.copy(folder / "given/maps/ear.exr", folder / name)
    shutil.copy(folder / "given/maps/environment.exr", folder / "studio.hdr.exr")
    (folder / "my").mkdir()
    shutil.copytree(folder / "given", folder / "my", dirs_exist_ok=True)
    (folder / "scene.json").write_text((folder / "given/scene.json").read_text().replace('"maps/', '"given/maps/')
                                       .replace('"meshes/', '"given/meshes/'))
    small = ("render", "given/scene.json", "--size", "32x18", "--bounces", "0", "-q", "--spp", "2")
    call("render", "given/scene.json", "--size", "64x32", "--spp", "1", "-q", "-o", "studio.hdr")
    for name in ("a.exr", "b.exr"):
        call(*small, "--layers", "depth", "-o", name)
    for k in range(2):
        call(*small, "--samples", f"{k}:{k + 1}", "-o", f"part{k}.exr")


def check_bench(relief: str, command: str) -> str:
    """The suite and its options exist."""
    words = command.split("#")[0].split()[2:]
    suite = next((word for word in words if not word.startswith("-")), "")
    help_text = subprocess.run([relief, "bench", suite, "--help-all"], text=True, capture_output=True)
    if help_text.returncode != 0:
        return f"no suite {suite}"
    missing = [w for w in words if w.startswith("-") and not re.search(rf"(?<![\w-]){re.escape(w)}\b", help_text.stdout)]
    return f"no option {' '.join(missing)}" if missing else ""


def check_commands(page: pathlib.Path, root: pathlib.Path, relief: str, given: pathlib.Path, path: pathlib.Path):
    """Those of one page, in order, in one folder. Returns faults and what was not run."""
    faults, left_out = [], []
    commands = pages.find_commands(page.read_text())
    name = page.relative_to(root)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        if commands or pages.find_scenes(page.read_text()):
            shutil.copytree(given, folder, dirs_exist_ok=True)
        for command in commands:
            if re.search(r"[\[<]|\.\.\.", command):
                left_out.append(f"{name}: {command}: a summary of usage")
            elif command.startswith("relief bench"):
                fault = check_bench(relief, command)
                faults += [f"{name}: {command}: {fault}"] if fault else []
                left_out.append(f"{name}: {command}: a measurement; its options were checked")
            elif re.match(r"(xvfb-run )?relief view", command):
                left_out.append(f"{name}: {command}: a window; its options were checked")
            elif any(need in command for need in NEEDS_DEVICE):
                left_out.append(f"{name}: {command}: needs a device or a cluster")
            else:
                done = run(command, folder, path)
                if done.returncode != 0:
                    faults.append(f"{name}: {command}: exit {done.returncode}\n{done.stdout}")
        for number, scene in enumerate(pages.find_scenes(page.read_text())):
            (folder / "given").mkdir(exist_ok=True)
            (folder / f"given/scene{number}.json").write_text(scene)
            done = run(f"relief render given/scene{number}.json --strict -o scene.png", folder, path)
            if done.returncode != 0:
                faults.append(f"{name}: scene {number}: exit {done.returncode}\n{done.stdout}")
    return faults, left_out


def check_names(page: pathlib.Path, root: pathlib.Path, options: str, targets: str) -> list[str]:
    """Links, options and targets of make."""
    text, name, faults = page.read_text(), page.relative_to(root), []
    for link in pages.find_links(text):
        target, _, anchor = link.partition("#")
        file = page if not target else (page.parent / target).resolve()
        if not file.exists():
            faults.append(f"{name}: link to {link}: no such file")
        elif anchor and anchor not in pages.find_anchors(file.read_text()):
            faults.append(f"{name}: link to {link}: no such heading")
    is_record = page.parent.name == "results"
    faults += [f"{name}: {option}: no option" for option in sorted(pages.find_options(text))
               if not is_record and not re.search(rf"(?<![\w-]){option}(?![\w-])", options)]
    faults += [f"{name}: make {target}: no such target" for target in pages.find_make_targets(text)
               if not re.search(rf"(?m)^{target}:|^\.PHONY:.*\b{target}\b", targets)]
    return faults


def collect_help(relief: str) -> str:
    def help_of(*words: str) -> str:
        return subprocess.run([relief, *words, "--help-all"], text=True, capture_output=True).stdout

    verbs = ["render", "inspect", "convert", "scene", "compare", "merge", "devices", "bench"]
    suites = re.findall(r"(?m)^  ([a-z]+[0-9]?) ", help_of("bench"))
    return "".join([help_of(), *(help_of(v) for v in verbs), *(help_of("bench", s) for s in suites),
                    *(help_of("farm", v) for v in ("plan", "submit", "work", "status", "merge", "retry"))])


def main() -> int:
    root, relief = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    every = pages.list_pages(root)
    options, targets = collect_help(relief), (root / "Makefile").read_text()
    options += "".join(file.read_text() for file in sorted(root.glob("tools/*.sh")) + sorted(root.glob("apps/gpu/*"))
                       + sorted(root.glob("python/relief/*/command.py")))
    # Of a program that not every build has.
    options += "".join((root / "apps" / file).read_text() for file in ("viewer/viewer_options.cpp", "common/map_options.cpp"))
    faults, left_out, count = [], [], 0
    for page in every:
        if page.name != "CHANGELOG.md":
            faults += check_names(page, root, options, targets)
    with tempfile.TemporaryDirectory() as scratch:
        given, path = pathlib.Path(scratch) / "given", pathlib.Path(scratch) / "bin"
        given.mkdir(), path.mkdir()
        make_files(given, relief)
        (path / "relief").write_text(SMALL % {"relief": relief})
        (path / "relief").chmod(0o755)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            current = [page for page in every if page.parent.name != "results"]  # those are records
            for some_faults, some in pool.map(lambda p: check_commands(p, root, relief, given, path), current):
                faults += some_faults
                left_out += some
    count = sum(len(pages.find_commands(page.read_text())) for page in current)
    print("not run:", *left_out, sep="\n  ")
    print(*faults, sep="\n")
    print(f"{count} commands of {len(every)} pages, {len(left_out)} not run, {len(faults)} faults")
    return 1 if faults or count - len(left_out) < 10 else 0


if __name__ == "__main__":
    sys.exit(main())
