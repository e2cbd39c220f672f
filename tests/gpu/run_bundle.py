"""The bundle runs from another folder without any environment, and its result is one JSON file that tells all.

run_bundle.py SOURCE_FOLDER BUILD_FOLDER
"""
import json
import pathlib
import subprocess
import sys
import tempfile

source, build = map(pathlib.Path, sys.argv[1:])


def run(bundle, folder, *arguments):
    # A few tests and nothing of this shell's environment: the bundle has to find its libraries and layers itself.
    command = ["env", "-i", "PATH=/usr/bin:/bin", "GTEST_FILTER=Commands.*", bundle / "run.sh", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    bundle = folder / "bundle"
    subprocess.run([source / "tools/make_gpu_bundle.sh", build, bundle], check=True)
    # Drivers of NVIDIA load these.
    for library in ["EGL.so.1", "GLX.so.0", "GL.so.1", "OpenGL.so.0", "GLESv2.so.2", "GLdispatch.so.0"]:
        assert (bundle / "fallback" / f"lib{library}").is_file(), library
    (folder / "elsewhere").mkdir()
    done = run(bundle, folder / "elsewhere", "--parts", "tests", "-o", "result.json")
    assert done.returncode == 0, done.stderr
    result = json.loads((folder / "elsewhere/result.json").read_text())
    assert result["all_passed"] is True, result
    assert result["commit"], result
    assert result["devices"][0]["driver"], result["devices"]
    tests = result["parts"]["tests"]
    assert tests["outcome"] == "passed" and tests["exit_code"] == 0, tests
    assert tests["result"] and all(shard["tests"] > 0 for shard in tests["result"]), tests
    # Drivers tell of kernels or say that they do not.
    run(bundle, folder, "--parts", "kernels")
    kernels = json.loads((folder / "relief-gpu.json").read_text())["parts"]["kernels"]
    if kernels["exit_code"] == 0:
        assert kernels["result"]["kernels"], kernels
    else:
        assert kernels["exit_code"] == 4 and kernels["result"] is None, kernels
    assert run(bundle, folder, "--parts", "nonsense").returncode == 2
    assert run(bundle, folder, "--nonsense").returncode == 2

    # What fails is told, not hidden: the programs are gone, the result is still written.
    (bundle / "vulkan_tests.gz").unlink()
    assert run(bundle, folder, "--parts", "tests").returncode == 1
    result = json.loads((folder / "relief-gpu.json").read_text())
    assert result["all_passed"] is False and result["parts"]["tests"]["outcome"] == "failed", result
    assert result["parts"]["tests"]["result"] is None, result
