"""Packs the extension with wheels of the module `relief`: make_addon.py WHEEL... -o FOLDER.

Writes FOLDER/relief_blender-VERSION.zip, which Blender installs by Preferences > Get Extensions > Install from Disk."""
import argparse
import pathlib
import re
import sys
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parent / "relief_blender"
PLATFORMS = {"manylinux": "linux-x64", "linux": "linux-x64", "win": "windows-x64", "macosx": "macos-arm64"}


def find_platform(wheel):
    tag = wheel.stem.split("-")[-1]
    return next((platform for start, platform in PLATFORMS.items() if tag.startswith(start)), None)


def fill_manifest(text, version, wheels):
    """The manifest with the version of the wheels, their names and platforms."""
    platforms = sorted({find_platform(wheel) for wheel in wheels})
    listed = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    for pattern, line in ((r"^version = .*$", f'version = "{version}"'), (r"^wheels = .*$", f"wheels = [{listed}]"),
                          (r"^platforms = .*$", "platforms = [" + ", ".join(f'"{p}"' for p in platforms) + "]"),
                          (r"^# make_addon.*\n", "")):
        text, count = re.subn(pattern, line, text, flags=re.M)
        assert count == 1, pattern
    return text


def write_zip(wheels, folder):
    """Path of the zip."""
    version = wheels[0].name.split("-")[1]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"relief_blender-{version}.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        manifest = (SOURCE / "blender_manifest.toml").read_text()
        archive.writestr("blender_manifest.toml", fill_manifest(manifest, version, wheels))
        for file in sorted(SOURCE.glob("*.py")):
            archive.write(file, file.name)
        for wheel in wheels:
            archive.write(wheel, f"wheels/{wheel.name}", zipfile.ZIP_STORED)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wheels", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", dest="folder", type=pathlib.Path, default=pathlib.Path("out"))
    arguments = parser.parse_args()
    for wheel in arguments.wheels:
        if not wheel.is_file() or find_platform(wheel) is None:
            sys.exit(f"{wheel}: no wheel for Linux, Windows or macOS")
    if len({wheel.name.split("-")[1] for wheel in arguments.wheels}) > 1:
        sys.exit("the wheels are of several versions")
    print(f"The add-on is {write_zip(arguments.wheels, arguments.folder).resolve()}")


if __name__ == "__main__":
    main()
