"""A shot whose camera and map change from frame to frame, and what tests of farms ask of a job of it."""
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "viewer"))
from small_scene import write_small_scene  # noqa: E402

FRAMES, TILES, PASSES = 10, 5, 2
TASKS = FRAMES * TILES * PASSES
OPTIONS = ["--size", "80x45", "--spp", "6", "--bounces", "2", "--layers", "depth,N,id"]


def run(program, *words, code=0):
    """The finished process; its exit code is `code`, unless that is None."""
    result = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if code is not None and result.returncode != code:
        raise AssertionError(f"{words} ended with {result.returncode}, not {code}:\n{result.stdout}{result.stderr}")
    return result


def write_shot(folder):
    """shot.json: the camera goes round, the map is another one at odd frames."""
    folder = pathlib.Path(folder)
    write_small_scene(folder)
    bumps = (folder / "bumps.png").read_bytes()
    for frame in range(1, FRAMES + 1):
        (folder / f"bumps.{frame:04}.png").write_bytes(bumps)
    scene = json.loads((folder / "scene.json").read_text())
    scene["camera"]["from"] = {"keys": [[1, [0.8, -1.5, 3]], [FRAMES, [-0.8, -1.2, 2.5]]]}
    scene["displacements"]["bumps"]["file"] = "bumps.####.png"
    scene["displacements"]["bumps"]["scale"] = {"keys": [[1, 0.4], [FRAMES, 0.1]]}
    (folder / "shot.json").write_text(json.dumps(scene, indent=1))


def render_reference(relief, folder):
    """All frames by one process: reference.####.exr."""
    run(relief, "render", folder / "shot.json", "--frames", f"1-{FRAMES}", *OPTIONS, "-o", folder / "reference.####.exr", "-q")


def plan(relief, folder, *more):
    return run(relief, "farm", "plan", folder / "shot.json", "--frames", f"1-{FRAMES}", "--tiles", TILES, "--passes", PASSES,
               *OPTIONS, "-o", folder / "job", "-q", *more)


def read_status(relief, job):
    return json.loads(run(relief, "farm", "status", job, "--json").stdout)


def expect_reference(relief, folder, job):
    """Each frame has the bits of the reference, and says the same of itself."""
    for frame in range(1, FRAMES + 1):
        written, wanted = job / "frames" / f"shot.{frame:04}.exr", folder / f"reference.{frame:04}.exr"
        run(relief, "compare", written, wanted)
        assert written.read_bytes() == wanted.read_bytes(), f"frame {frame} has other bytes"


def list_attempts(job, state):
    """(task, who) of the attempts in that state."""
    names = [path.name for path in (job / "state").glob("*/*")]
    found = [re.fullmatch(r"(\d+)\.([^.]+)\." + state + r"(?:\..*)?", name) for name in names]
    return [(int(match[1]), match[2]) for match in found if match]


def choose_victims(seed=29):
    """A third of all tasks."""
    return set(random.Random(seed).sample(range(TASKS), TASKS // 3))


def disturb_unfinished(job, task, who, disturb):
    """Calls disturb(process) for the process of an attempt if the film of its task is not in place yet.

    The process is stopped first, so that it cannot finish meanwhile. If `disturb` returns false, the process continues.
    Otherwise it stays stopped until the kill, or until Slurm continues it with the signal that ends it.
    Returns whether the process was disturbed."""
    process = int(who.split("-")[1])
    if not send_signal(process, signal.SIGSTOP):
        return False  # it has just ended
    while (state := read_process_state(process)) not in ("T", "Z", ""):
        time.sleep(0.001)
    is_met = state == "T" and not any((job / "parts").glob(f"*/{task}.film")) and disturb(process)
    if not is_met:
        send_signal(process, signal.SIGCONT)
    return is_met


def send_signal(process, number):
    """Whether there was such a process."""
    try:
        os.kill(process, number)
        return True
    except ProcessLookupError:
        return False


def kill(process):
    return send_signal(process, signal.SIGKILL)


def read_process_state(process):
    """The letter that Linux gives the state of a process, as "T" for a stopped one; empty: there is no such process."""
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return ""


def damage(film):
    """One bit in the middle."""
    data = bytearray(film.read_bytes())
    data[len(data) // 2] ^= 4
    film.write_bytes(data)
