"""Installs a build into an empty prefix, moves it, builds the examples against it as another project would, and runs them.

check_install.py SOURCE BUILD [COMPILER]
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

source, build = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
compiler = sys.argv[3] if len(sys.argv) > 3 else "c++"


def run(*command, **options):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if result.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}exit {result.returncode}")
    return result.stdout


def expect(condition, message):
    if not condition:
        raise SystemExit(message)


def read_option(name):
    lines = (build / "CMakeCache.txt").read_text().splitlines()
    return any(line.startswith(f"{name}:") and line.rpartition("=")[2] in ("ON", "TRUE", "1") for line in lines)


has_io, has_command = read_option("RELIEF_IO"), read_option("RELIEF_IO") and read_option("RELIEF_APPS")
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    # What is not built is built: after `make render` only the command is. No other test needs these libraries.
    for library in (build / "lib").glob("librelief*"):
        library.unlink()
    components = ["runtime", "development"] + (["command"] if has_command else [])
    for component in components:
        run("cmake", "--install", build, "--prefix", folder / "first", "--component", component)
    # What names a place of the build or of the first prefix fails from here on.
    prefix = folder / "moved"
    shutil.move(folder / "first", prefix)
    installed = {path.relative_to(prefix).as_posix() for path in prefix.rglob("*") if path.is_file()}
    expect("include/relief/version.h" in installed, "relief/version.h is not installed")
    expect(("include/relief/io.h" in installed) == has_io, "io.h and RELIEF_IO do not go together")
    for path in prefix.rglob("*"):
        if path.is_file() and path.suffix in {".cmake", ".pc", ".h"}:
            for place in (str(source) + "/", str(build), str(folder / "first")):
                expect(place not in path.read_text(), f"{path} names {place}")

    # CMake
    examples = folder / "examples"
    run("cmake", "-S", source / "examples", "-B", examples, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release",
        f"-DCMAKE_CXX_COMPILER={compiler}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DCMAKE_CXX_COMPILER_LAUNCHER=")
    for entry in json.loads((examples / "compile_commands.json").read_text()):
        flags = entry["command"].split()
        ours = [flag for flag in flags if flag.startswith(("-W", "-ffp", "-fno-math", "-fsanitize", "-fvisibility"))]
        expect(not ours, f"flags of Relief reach another project: {ours}")
    run("cmake", "--build", examples)
    hits = run(examples / "intersect").splitlines()
    expect(len(hits) == 6 and "no hit" in hits[1] and "height 1.000" in hits[3] and "no hit" in hits[5],
           "unexpected hits:\n" + "\n".join(hits))
    if has_io:
        for name in ("picture.exr", "picture.png"):
            text = run(examples / "render", folder / name)
            expect("160 x 120" in text, f"unexpected picture: {text}")
    missing = subprocess.run(["cmake", "-S", source / "tests/package/absent", "-B", folder / "absent",
                              f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={compiler}"], capture_output=True, text=True)
    expect(missing.returncode and "no component absent" in " ".join(missing.stderr.split()), "an unknown component was found")

    # pkg-config
    environment = os.environ | {"PKG_CONFIG_PATH": str(next(prefix.rglob("relief.pc")).parent)}
    program, package = ("render", "relief_io") if has_io else ("intersect", "relief")
    flags = run("pkg-config", "--cflags", "--libs", package, env=environment).split()
    library_folder = next(prefix.rglob("relief.pc")).parent.parent
    run(compiler, "-std=c++20", source / "examples" / program / "main.cpp", *flags, f"-Wl,-rpath,{library_folder}",
        "-o", folder / program)
    run(folder / program, *([folder / "by_pkgconfig.png"] if has_io else []))

    # The command, which finds its module beside itself in the prefix.
    if has_command:
        version = run(prefix / "bin/relief", "--version").split()[1]
        expect(version in hits[0], f"the library is {hits[0]}, the command {version}")
        for name in ("share/man/man1/relief.1", "share/bash-completion/completions/relief",
                     "share/zsh/site-functions/_relief", "share/fish/vendor_completions.d/relief.fish"):
            expect(name in installed, f"{name} is not installed")
        run(prefix / "bin/relief", "compare", folder / "picture.png", folder / "picture.png")
        path = run("readelf", "-d", prefix / "bin/relief")
        expect(str(build) not in path, "the installed command looks into the folder of its build")
print(f"{len(installed)} files installed")
