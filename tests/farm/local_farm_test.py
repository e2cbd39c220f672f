"""A farm of processes of this machine: local_farm_test.py RELIEF.

100 tasks, a third of them killed once while they run, one rendered twice at once, one part damaged: the frames have the
bits of one render, nothing is lost, and `status` tells each event. Then an interrupt that loses no sample.
"""
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from farm_shot import (TASKS, choose_victims, damage, disturb_unfinished, expect_reference, kill, list_attempts, plan, read_status,
                       render_reference, run, write_shot)

PATIENCE = 600
TWICE, DAMAGED = 7, 42


def kill_victims(job, victims, is_over):
    """Kills each of these tasks once, as soon as it says that it runs. Returns the tasks that were killed."""
    killed = set()
    while not is_over():
        for task, who in list_attempts(job, "running"):
            if task in victims and task not in killed and disturb_unfinished(job, task, who, kill):
                killed.add(task)
        time.sleep(0.002)
    return killed


def check_killed_workers(relief, folder):
    job = folder / "job"
    plan(relief, folder)
    farm = subprocess.Popen([relief, "farm", "submit", job, "--workers", "3", "--threads", "1", "--no-merge", "-q"],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    twins = [subprocess.Popen([relief, "farm", "work", job, "--task", str(TWICE), "--again", "--threads", "1"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(2)]
    end = time.monotonic() + PATIENCE
    killed = kill_victims(job, choose_victims() - {TWICE}, lambda: farm.poll() is not None or time.monotonic() > end)
    output, errors = farm.communicate(timeout=10)
    assert farm.returncode == 0, f"submit ended with {farm.returncode}:\n{output}{errors}"
    assert [twin.wait() for twin in twins] == [0, 0]
    assert len(killed) >= TASKS // 4, f"{len(killed)} processes were killed in time"
    status = read_status(relief, job)
    assert status["tasks"]["done"] == TASKS, status
    assert status["events"]["lost"] == len(killed), status
    assert status["events"]["done_twice"] >= 1, status
    print(f"{len(killed)} of {TASKS} tasks were killed once: {output.strip()}")


def check_damaged_part(relief, folder):
    job = folder / "job"
    damage(job / "parts/000000" / f"{DAMAGED}.film")
    merged = run(relief, "farm", "merge", job, "-q", code=3)
    assert f"task {DAMAGED}, frame 5, tile 1/5, samples 0:3" in merged.stderr, merged.stderr
    assert "frame 5 is not whole" in merged.stderr, merged.stderr
    status = read_status(relief, job)
    assert status["events"]["damaged"] >= 1 and status["tasks"]["waiting"] == 1, status
    assert status["frames"]["written"] == 9, status
    run(relief, "farm", "submit", job, "--threads", "1", "-q")
    assert read_status(relief, job)["frames"]["written"] == 10
    expect_reference(relief, folder, job)
    # Nothing is left to be done, and nothing is done again.
    again = run(relief, "farm", "submit", job, "-q")
    assert "wrote 0 frames; 10 were there already" in again.stdout, again.stdout


def check_interrupt(relief, folder):
    """SIGTERM in the midst of a task gives back its samples; the next attempt renders the rest."""
    job, options = folder / "long", ["--size", "96x64", "--bounces", "1", "--spp", "1500", "--threads", "1", "-q"]
    run(relief, "farm", "plan", folder / "shot.json", "--frames", "3", "--checkpoint", "0.001", *options, "-o", job)
    worker, end = subprocess.Popen([relief, "farm", "work", job, "--task", "0", "--log"]), time.monotonic() + PATIENCE
    while time.monotonic() < end and worker.poll() is None and not list((job / "parts").glob("*/0.*.film")):
        time.sleep(0.01)
    worker.send_signal(signal.SIGTERM)
    assert worker.wait() == 128 + signal.SIGTERM
    status = read_status(relief, job)
    assert status["tasks"]["partial"] == 1 and (job / "parts/000000/0.partial.film").exists(), status
    missing = run(relief, "farm", "merge", job, "-q", code=3).stderr
    assert "interrupted, some samples are there" in missing, missing
    retried = run(relief, "farm", "retry", job)
    assert "0 failed, 0 stale and 1 partial tasks: 0" in retried.stdout, retried.stdout
    run(relief, "farm", "retry", job, "--submit", "local", "-q")
    run(relief, "render", folder / "shot.json", "--frames", "3", *options, "-o", folder / "long.####.exr")
    assert (job / "frames/shot.0003.exr").read_bytes() == (folder / "long.0003.exr").read_bytes()
    assert read_status(relief, job)["events"]["interrupted"] == 1
    assert not (job / "parts/000000/0.partial.film").exists()


def main():
    relief = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_shot(folder)
        render_reference(relief, folder)
        check_killed_workers(relief, folder)
        check_damaged_part(relief, folder)
        run(relief, "farm", "status", folder / "job", "--sheet", folder / "sheet.png")
        assert (folder / "sheet.png").read_bytes().startswith(b"\x89PNG")
        check_interrupt(relief, folder)


if __name__ == "__main__":
    main()
