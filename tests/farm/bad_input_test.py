"""What a farm is told of bad input, and what it leaves as it was: bad_input_test.py RELIEF."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from farm_shot import damage, read_status, run, write_shot

SMALL = ["--size", "32x18", "--spp", "2", "--bounces", "1", "-q"]


def plan(relief, folder, job, *more, code=0):
    return run(relief, "farm", "plan", folder / "shot.json", "--frames", "1-3", "--tiles", "2", *SMALL, "-o", folder / job, *more,
               code=code)


def expect(text, *parts):
    for part in parts:
        assert part in text, f"no {part!r} in:\n{text}"


def check_plan(relief, folder):
    plan(relief, folder, "job")
    manifest = (folder / "job/job.json").read_bytes()
    expect(plan(relief, folder, "job", code=2).stderr, "is there already", "another folder")
    assert (folder / "job/job.json").read_bytes() == manifest
    missing = run(relief, "farm", "plan", folder / "shot.json", "--frames", "9-12", *SMALL, "-o", folder / "gap", code=3).stderr
    expect(missing, "bumps.0011.png", "there is no such file", "at frame 11")
    assert not (folder / "gap").exists()
    expect(plan(relief, folder, "x", "--passes", "3", code=2).stderr, "--passes", "only 2 samples")
    expect(plan(relief, folder, "x", "--pictures", folder / "bumps.####.png", code=2).stderr, "would be written over")
    expect(run(relief, "farm", "plan", folder / "plane.obj", "-o", folder / "x", code=2).stderr, "frames are those of a scene file")
    expect(run(relief, "farm", "plan", folder / "scene.json", *SMALL, "-o", folder / "x", code=2).stderr, "names no frames")
    expect(plan(relief, folder, "x", "--noise", "0.1", code=2).stderr, "unknown option '--noise'")
    assert not (folder / "x").exists()
    expect(run(relief, "farm", "plam", code=2).stderr, "'plan'")
    expect(run(relief, "farm", "--tiles", code=2).stderr, "unknown option '--tiles'", "relief farm --help")
    expect(run(relief, "farm", code=2).stderr, "relief farm: no command given")
    expect(run(relief, "farm", "work", folder / "job", "--task", "6", code=2).stderr, "from 0 to 5")
    expect(run(relief, "farm", "submit", folder / "job", "--partition", "a", code=2).stderr, "--to slurm")


def check_strict_plan(relief, folder):
    """What all tasks would end with is told before there is a job."""
    for tile in (1001, 1002):
        (folder / f"bumps.{tile}.png").write_bytes((folder / "bumps.png").read_bytes())
    shot = json.loads((folder / "shot.json").read_text())
    shot["displacements"]["bumps"]["file"] = "bumps.1001.png"
    (folder / "tile.json").write_text(json.dumps(shot))
    words = ["farm", "plan", folder / "tile.json", "--frames", "1", "--size", "32x18", "--spp", "2", "-o", folder / "warned"]
    told = run(relief, *words, "--strict", code=6).stderr
    expect(told, "is one tile of several", "nothing is planned with warnings under --strict")
    assert not (folder / "warned").exists()
    expect(run(relief, *words).stderr, "is one tile of several")
    shot["displacements"]["bumps"].update(file="bumps.png", scale=1e30)
    (folder / "far.json").write_text(json.dumps(shot))
    expect(run(relief, "farm", "plan", folder / "far.json", "--frames", "1", *SMALL, "-o", folder / "far", code=3).stderr,
           "displaces by", "lower the scale")
    assert not (folder / "far").exists()


def check_changed_file(relief, folder):
    job, image = folder / "job", folder / "bumps.0002.png"
    before = image.read_bytes()
    image.write_bytes(before + b"\0")
    expect(run(relief, "farm", "work", job, "--task", "2", code=3).stderr, "bumps.0002.png", "was changed after the job was planned")
    run(relief, "farm", "work", job, "--task", "0-1")  # frame 1 does not read it
    status = read_status(relief, job)
    assert status["tasks"]["failed"] == 1 and status["tasks"]["done"] == 2, status
    expect(status["failed"][0]["reason"], "bumps.0002.png")
    run(relief, "farm", "retry", job)
    told = run(relief, "farm", "submit", job, "--workers", "1", code=3).stderr
    expect(told, "task 2 (frame 2", "bumps.0002.png: the file was changed after the job was planned", "tells why")
    image.write_bytes(before)  # its time is another, its content is not
    retried = run(relief, "farm", "retry", job)
    expect(retried.stdout, "2 failed, 0 stale and 0 partial tasks: 2-3", "relief farm submit")
    run(relief, "farm", "work", job, "--task", "2")
    scene = (folder / "shot.json").read_text()
    (folder / "shot.json").write_text(scene.replace("0.6", "0.5"))
    expect(run(relief, "farm", "work", job, "--task", "3", code=3).stderr, "shot.json", "was changed")
    (folder / "shot.json").write_text(scene)
    run(relief, "farm", "retry", job, "--submit", "local", "-q")
    assert read_status(relief, job)["frames"]["written"] == 3


def check_other_version(relief, folder):
    manifest = folder / "job/job.json"
    text = manifest.read_text()
    job = json.loads(text)
    job["version"] = "0.0.1"
    manifest.write_text(json.dumps(job))
    expect(run(relief, "farm", "work", folder / "job", "--task", "0", "--again", code=3).stderr, "Relief 0.0.1 planned this job")
    expect(run(relief, "farm", "merge", folder / "job", code=3).stderr, "Relief 0.0.1 planned this job")
    manifest.write_text(text[:200])
    expect(run(relief, "farm", "status", folder / "job", code=3).stderr, "the manifest is damaged", "plan the job again")
    manifest.write_text(text)
    expect(run(relief, "farm", "status", folder / "nowhere", code=3).stderr, "there is no manifest of a job")


def check_full_disk(relief, folder):
    """A disk of its own in a namespace of its own, where the system allows that."""
    plan(relief, folder, "full")
    script = ("mount -t tmpfs -o size=4k none \"$1/full/parts\" && \"$0\" farm work \"$1/full\" --task 0; echo \"exit $?\"; "
              "\"$0\" farm status \"$1/full\"; echo \"left: $(ls $1/full/parts/000000)\"")
    (folder / "full/parts").mkdir()
    result = subprocess.run(["unshare", "--mount", "sh", "-c", script, relief, str(folder)], capture_output=True, text=True)
    if "exit " not in result.stdout or "mount:" in result.stderr:
        print("without a full disk: no file system may be mounted here")
        return
    expect(result.stdout, "1 failed", "left: \n")
    expect(result.stderr, "No space left on device", "check free space")


def check_damaged_films(relief, folder):
    """All are named by one run, and no more than those."""
    words = [relief, "farm", "plan", folder / "shot.json", "--frames", "1-2", "--tiles", "2", "--passes", "2", *SMALL]
    run(*words, "-o", folder / "films")
    run(relief, "farm", "submit", folder / "films", "--no-merge", "-q")
    films = folder / "films/parts/000000"
    damage(films / "0.film")
    (films / "3.film").write_bytes((films / "3.film").read_bytes()[:100])
    (films / "5.film").unlink()
    (films / "6.film").unlink()
    os.mkfifo(films / "6.film")
    (films / "7.film").rename(folder / "elsewhere.film")
    (films / "7.film").symlink_to(folder / "elsewhere.film")
    for verb in ("merge", "submit"):
        copy = folder / f"films-{verb}"
        shutil.copytree(folder / "films", copy, symlinks=True, ignore=lambda _, names: [n for n in names if n == "6.film"])
        os.mkfifo(copy / "parts/000000/6.film")
        told = run(relief, "farm", verb, copy, "-q", code=3).stderr
        named = sorted(int(line.split("task ")[1].split(",")[0]) for line in told.splitlines() if "a part is damaged" in line)
        assert named == [0, 3, 5, 6, 7], told
        expect(told, "a symbolic link leads out of the job", "is a device, a pipe or the like")
        run(relief, "farm", "submit", copy, "-q")
        assert read_status(relief, copy)["frames"]["written"] == 2


def check_manifest_limits(relief, folder):
    """Those of `farm plan`; nothing is allocated for a count beyond them."""
    plan(relief, folder, "limits")
    manifest = folder / "limits/job.json"
    text = manifest.read_text()
    for key, value in (("tiles", 0), ("tiles", 19), ("tiles", 2**32 + 2), ("tiles", 2.5), ("passes", -1), ("passes", 3),
                       ("width", 65537), ("height", 10**30), ("spp", 2**40), ("heartbeat_s", 0), ("heartbeat_s", 1e300),
                       ("tiles", "2"), ("frames", "1-100000000000"), ("frames", "1-2000000000"), ("layout", 1.5)):
        job = json.loads(text)
        job[key] = value
        manifest.write_text(json.dumps(job))
        for verb in ("status", "merge", "submit", "retry"):
            expect(run(relief, "farm", verb, folder / "limits", code=3).stderr, "limits/job.json")
    job = json.loads(text)
    job.update(height=65536, spp=4096, tiles=65536, passes=4096)
    manifest.write_text(json.dumps(job))
    expect(run(relief, "farm", "status", folder / "limits", code=3).stderr, "more than 100000000")
    for key, value in (("threads", 10**9), ("ready_s", -1), ("memory_bytes", 1e300)):
        job = json.loads(text)
        job["estimate"][key] = value
        manifest.write_text(json.dumps(job))
        expect(run(relief, "farm", "status", folder / "limits", code=3).stderr, f"'{key}' is")


def check_links_and_pipes(relief, folder):
    """What another user of the storage may put into a job: nothing outside is read or written, and nothing waits."""
    outside = folder / "outside"
    outside.mkdir()
    for place in ("state", "parts", "log", "previews"):
        job = folder / f"link-{place}"
        plan(relief, folder, job.name)
        (job / place).rmdir() if (job / place).exists() else None
        (job / place).symlink_to(outside)
        result = run(relief, "farm", "work", job, "--task", "0", *(["--log"] if place == "log" else []), code=3)
        expect(result.stderr, "a symbolic link leads out of the job")
        assert not list(outside.iterdir()), place
    job = folder / "link-frames"
    plan(relief, folder, job.name)
    (job / "frames").rmdir()
    (job / "frames").symlink_to(outside)
    expect(run(relief, "farm", "submit", job, "-q", code=3).stderr, "link-frames/frames: a symbolic link leads out of the job")
    assert not list(outside.iterdir())
    job = folder / "link-log-file"
    plan(relief, folder, job.name)
    secret = folder / "secret.txt"
    secret.write_text("secret\n")
    (job / "log/000000").mkdir(parents=True)
    (job / "log/000000/0.txt").symlink_to(secret)
    expect(run(relief, "farm", "work", job, "--task", "0", "--log", code=3).stderr, "a symbolic link leads out of the job")
    (job / "state/000000").mkdir()
    (job / "state/000000/0.host-1-1.failed.1").symlink_to(secret)
    os.mkfifo(job / "state/000000/1.host-1-1.failed.1")
    os.mkfifo(job / "log/000000/1.txt")
    (job / "written").mkdir()
    told = run(relief, "farm", "status", job).stdout
    expect(told, "a symbolic link leads out of the job", "is a device, a pipe or the like")
    assert "secret\n" not in told and secret.read_text() == "secret\n"
    pipe = folder / "pipe"
    pipe.mkdir()
    os.mkfifo(pipe / "job.json")
    expect(run(relief, "farm", "status", pipe, code=3).stderr, "is a device, a pipe or the like")
    (folder / "moved").symlink_to(folder / "job")  # the job folder itself may be a link
    read_status(relief, folder / "moved")


def check_rights(relief, folder):
    """Of a folder that nobody can write to, neither can root."""
    plan(relief, folder, "closed")
    state = folder / "closed/state"
    state.rmdir()
    state.write_text("a file where a folder should be")
    expect(run(relief, "farm", "work", folder / "closed", "--task", "0", code=1).stderr, "state/000000", "the right to write there")
    if os.getuid() != 0:
        (folder / "locked").mkdir(mode=0o500)
        expect(plan(relief, folder, "locked/job", code=1).stderr, "locked/job", "the right to write there")


def main():
    relief = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_shot(folder)
        check_plan(relief, folder)
        check_strict_plan(relief, folder)
        check_changed_file(relief, folder)
        check_other_version(relief, folder)
        check_full_disk(relief, folder)
        check_damaged_films(relief, folder)
        check_manifest_limits(relief, folder)
        check_links_and_pipes(relief, folder)
        check_rights(relief, folder)


if __name__ == "__main__":
    main()
