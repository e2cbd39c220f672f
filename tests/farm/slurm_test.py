"""A farm on a real Slurm that the test starts: slurm_test.py RELIEF. Exit 77, skipped, where that cannot be.

100 tasks in three array jobs; a third of them is killed or requeued while it runs, one is rendered twice at once, one part is
damaged: the frames have the bits of one render, and `status` tells each event. A requeued task waits two minutes.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from farm_shot import (TASKS, choose_victims, damage, disturb_unfinished, expect_reference, kill, list_attempts, plan, read_status,
                       render_reference, run, write_shot)
from slurm_cluster import Cluster, find_obstacle

PATIENCE = 1500
TWICE, DAMAGED = 7, 42


def find_slurm_task(process):
    """JOB_INDEX of a process, from its environment."""
    try:
        data = pathlib.Path(f"/proc/{process}/environ").read_bytes().decode(errors="replace")
    except OSError:
        return None
    job = re.search(r"SLURM_ARRAY_JOB_ID=(\d+)", data)
    index = re.search(r"SLURM_ARRAY_TASK_ID=(\d+)", data)
    return f"{job[1]}_{index[1]}" if job and index else None


def disturb(cluster, job, task, who):
    """Every second victim is requeued, the others are killed. Whether it was met in time."""
    def requeue(process):
        name = find_slurm_task(process)
        return bool(name) and subprocess.run(["scontrol", "requeue", name], env=cluster.environment,
                                             capture_output=True).returncode == 0
    return disturb_unfinished(job, task, who, requeue if task % 2 == 0 else kill)


def is_idle(cluster):
    return cluster.ask("squeue", "-h").strip() == ""


def disturb_all(cluster, job, victims):
    met = {"killed": set(), "requeued": set()}
    end = time.monotonic() + PATIENCE
    while not is_idle(cluster):
        assert time.monotonic() < end, cluster.ask("squeue")
        for _ in range(100):
            for task, who in list_attempts(job, "running"):
                kind = "requeued" if task % 2 == 0 else "killed"
                if task in victims and task not in {other for other, _ in met[kind]} and disturb(cluster, job, task, who):
                    met[kind].add((task, who))
            time.sleep(0.005)
    return met


def submit(cluster, relief, *words):
    result = subprocess.run([relief, "farm", *map(str, words)], env=cluster.environment, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def check(cluster, relief, folder):
    job = folder / "job"
    plan(relief, folder, "--heartbeat", "1")
    output = submit(cluster, relief, "submit", job, "--to", "slurm", "--partition", "farm", "--sbatch=--nice=1")
    assert "100 tasks as 100 elements of 3 array jobs" in output and "frames are written by job" in output, output
    twins = [subprocess.Popen([relief, "farm", "work", job, "--task", str(TWICE), "--again"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
             for _ in range(2)]
    met = disturb_all(cluster, job, choose_victims() - {TWICE})
    assert [twin.wait() for twin in twins] == [0, 0]
    print(f"{len(met['killed'])} tasks were killed, {len(met['requeued'])} requeued")
    assert len(met["killed"]) >= 10 and len(met["requeued"]) >= 8, met
    merged = next((job / "submitted/1").glob("merge.txt")).read_text()
    assert "is not whole, missing: frame" in merged, merged
    status = read_status(relief, job)
    assert status["tasks"]["done"] == TASKS - len(met["killed"]), status
    damage(job / "parts/000000" / f"{DAMAGED}.film")
    submit(cluster, relief, "retry", job, "--submit", "slurm")
    cluster.await_true(lambda: is_idle(cluster), "an empty queue", PATIENCE)
    while read_status(relief, job)["frames"]["written"] < 10:  # the part was found to be damaged when frames were written
        submit(cluster, relief, "retry", job, "--submit", "slurm")
        cluster.await_true(lambda: is_idle(cluster), "an empty queue", PATIENCE)
    status = read_status(relief, job)
    lost, partial, done = [set(list_attempts(job, state)) for state in ("lost", "partial", "done")]
    assert met["killed"] <= lost, met["killed"] - lost
    # Slurm continues a process before it ends it, and the fastest are done by then.
    assert met["requeued"] <= lost | partial | done, met["requeued"] - lost - partial - done
    assert len(met["requeued"] - done) >= 6, met["requeued"] & done
    events = status["events"]
    assert (events["lost"], events["interrupted"]) == (len(lost), len(partial)), status
    assert events["done_twice"] >= 1, status
    expect_reference(relief, folder, job)


def main():
    relief = sys.argv[1]
    obstacle = find_obstacle()
    if obstacle:
        print(f"skipped: {obstacle}")
        return 77
    with tempfile.TemporaryDirectory() as name, tempfile.TemporaryDirectory() as cluster_folder:
        folder = pathlib.Path(name)
        write_shot(folder)
        render_reference(relief, folder)
        with Cluster(cluster_folder) as cluster:
            check(cluster, relief, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
