"""The command with the real Open Image Denoise of a package: it is found, it takes noise away, it keeps what was there.

usage: check_denoiser.py RELIEF"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import pyoidn

RELIEF = sys.argv[1]
# The command asks `python3` on the path for packages.
os.environ["PATH"] = f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"


def run(*arguments, expected=0, **environment):
    done = subprocess.run([RELIEF, *map(str, arguments)], env=dict(os.environ, **environment), text=True,
                          capture_output=True)
    assert done.returncode == expected, f"{arguments}: exit {done.returncode}\n{done.stderr}"
    return done.stdout + done.stderr


def difference(a, b):
    done = subprocess.run([RELIEF, "compare", a, b, "--json"], text=True, capture_output=True)
    return json.loads(done.stdout)


def main():
    folder = pathlib.Path(tempfile.mkdtemp())
    scene = folder / "ear" / "scene.json"
    run("scene", "ear", "-o", folder / "ear")
    common = ["render", scene, "--size", "320x240", "--progress", "none"]
    run(*common, "--spp", 8, "-o", folder / "noisy.exr")
    run(*common, "--spp", 8, "--denoise", "-o", folder / "clean.exr")
    run(*common, "--spp", 512, "--seed", 1, "-o", folder / "reference.exr")
    clean = difference(folder / "clean.exr", folder / "reference.exr")["rms"]
    noisy = difference(folder / "noisy.exr", folder / "reference.exr")["rms"]
    print(f"rms error of 8 samples: {noisy:.5f}, denoised {clean:.5f}")
    assert clean < 0.5 * noisy, "as much as four times the samples take away"
    # Parts are joined, then denoised.
    for part in ("0:4", "4:8"):
        run(*common, "--samples", part, "--layers", "guide_albedo,guide_N,direct", "-o", folder / f"part{part[0]}.exr")
    parts = [folder / "part0.exr", folder / "part4.exr"]
    run("merge", *parts, "--denoise", "-o", folder / "merged.exr")
    merged = difference(folder / "merged.exr", folder / "clean.exr")
    assert merged["rms"] < 1e-3, merged
    run("merge", *parts, "--denoise", "-o", folder / "merged.exr", RELIEF_OIDN=str(folder), expected=4)
    library = next(pathlib.Path(pyoidn.__file__).parent.rglob("libOpenImageDenoise.so.2"))
    for named in (library, library.parent):
        run(*common, "--spp", 1, "--denoise", "-o", folder / "named.png", RELIEF_OIDN=str(named))
    print(run(*common, "--spp", 1, "--denoise", "-o", folder / "none.png", RELIEF_OIDN=str(folder), expected=4))


if __name__ == "__main__":
    main()
