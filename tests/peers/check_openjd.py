"""The template of `relief farm submit --to openjd` by openjd-cli: check_openjd.py RELIEF."""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "farm"))
from farm_shot import TASKS, expect_reference, plan, read_status, render_reference, run, write_shot  # noqa: E402

OPENJD = pathlib.Path(sys.executable).parent / "openjd"


def run_openjd(*words):
    result = subprocess.run([OPENJD, *map(str, words)], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def main():
    relief = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        job = folder / "job"
        write_shot(folder)
        render_reference(relief, folder)
        plan(relief, folder)
        output = run(relief, "farm", "submit", job, "--to", "openjd", "--group", "8").stdout
        assert "--run-dependencies --step Merge" in output, output
        template = job / "submitted/1/openjd.json"
        run_openjd("check", template)
        run_openjd("run", template, "--run-dependencies", "--step", "Merge")
        status = read_status(relief, job)
        assert status["tasks"]["done"] == TASKS and status["frames"]["written"] == 10, status
        expect_reference(relief, folder, job)


if __name__ == "__main__":
    main()
