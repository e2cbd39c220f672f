"""The commit that programs are built with follows the sources, and its file stays as it is where the commit does.

commit_test.py SOURCE_FOLDER CMAKE
"""
import pathlib
import subprocess
import sys
import tempfile

source, cmake = sys.argv[1:]


def run(*command, folder):
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout.strip()


def git(folder, *words):
    return run("git", "-c", "user.name=test", "-c", "user.email=test@localhost", *words, folder=folder)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name) / "sources"
    folder.mkdir()
    file = pathlib.Path(name) / "commit.cpp"

    def write():
        run(cmake, "-D", f"FOLDER={folder}", "-D", f"FILE={file}", "-P", f"{source}/cmake/WriteCommit.cmake", folder=folder)
        return file.read_text()

    assert '"unknown"' in write()
    git(folder, "init", "-q")
    (folder / "a").write_text("1")
    git(folder, "add", "a")
    git(folder, "commit", "-q", "-m", "First")
    first = git(folder, "rev-parse", "--short=10", "HEAD")
    assert f'"{first}"' in write(), file.read_text()
    before = file.stat().st_mtime_ns
    write()
    assert file.stat().st_mtime_ns == before
    (folder / "a").write_text("2")
    assert f'"{first}-dirty"' in write(), file.read_text()
    git(folder, "commit", "-q", "-a", "-m", "Second")
    second = git(folder, "rev-parse", "--short=10", "HEAD")
    assert second != first and f'"{second}"' in write(), file.read_text()
