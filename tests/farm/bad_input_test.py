"""What a farm is told of bad input, and what it leaves as it was: bad_input_test.py RELIEF."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from farm_shot import read_status, run, write_shot

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
        check_rights(relief, folder)


if __name__ == "__main__":
    main()
