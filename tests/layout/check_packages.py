"""Every package that CMake looks for, and every tool that the scripts call, stands in tools/packages.txt."""
import pathlib
import re
import sys

from sources import finish, list_files

PACKAGES = {
    "TBB": ["libtbb-dev"],
    "fmt": ["libfmt-dev"],
    "hwy": ["libhwy-dev"],
    "XXHASH_INCLUDE": ["libxxhash-dev"],
    "OPENSUBDIV_LIBRARY": ["libosd-dev"],
    "OPENSUBDIV_FOLDER": ["libosd-dev"],
    # Its CMake file names the tools, and the headers those of Imath.
    "OpenImageIO": ["libopenimageio-dev", "openimageio-tools", "libimath-dev"],
    "OPENCOLORIO_LIBRARY": ["libopencolorio-dev"],
    "OPENCOLORIO_FOLDER": ["libopencolorio-dev"],
    "OpenEXR": ["libopenexr-dev", "libimath-dev"],
    "PNG": ["libpng-dev"],
    "ZLIB": ["zlib1g-dev"],
    "TIFF": ["libtiff-dev"],
    "JPEG": ["libjpeg-dev"],
    "nlohmann_json": ["nlohmann-json3-dev"],
    "assimp": ["libassimp-dev"],
    "DRACO_LIBRARY": ["libdraco-dev"],
    "DRACO_FOLDER": ["libdraco-dev"],
    "MESHOPT_LIBRARY": ["libmeshoptimizer-dev"],
    "MESHOPT_FOLDER": ["libmeshoptimizer-dev"],
    "CLI11": ["libcli11-dev"],
    "GTest": ["libgtest-dev"],
    # Only `relief bench triangles` needs it.
    "embree": ["libembree-dev"],
    "Python3": ["python3"],
    "Python": ["python3-dev", "python3-venv"],
    # From the Python package index, as a part of the build of the Python module.
    "nanobind": [],
    # The window of the viewer.
    "glfw3": ["libglfw3-dev"],
    "OpenGL": ["libgl-dev"],
    "IMGUI_FOLDER": ["libimgui-dev"],
    "IMGUI_LIBRARY": ["libimgui-dev"],
    "STB_LIBRARY": ["libstb-dev"],
    "STB_FOLDER": ["libstb-dev"],
    # What the tests of an installed Relief look for.
    "relief": ["pkgconf"],
    # The headers; the loader comes with them. Tests need a driver and the validation layer.
    "Vulkan": ["libvulkan-dev", "mesa-vulkan-drivers", "vulkan-validationlayers"],
}
TOOLS = ["clang", "lld", "llvm", "clang-format", "libclang-rt-14-dev", "cmake", "ninja-build", "make", "glslc", "doxygen", "python3-matplotlib", "xvfb"]
# Libraries that tools/make_gpu_bundle.sh packs for a driver, as it pairs them with their packages.
BUNDLED = r"lib\w+\.so\.\d+:(\w+)"

root = pathlib.Path(sys.argv[1])
listed = set((root / "tools/packages.txt").read_text().splitlines())
needed = {tool: "the presets and the Makefile" for tool in TOOLS}
bundle = root / "tools/make_gpu_bundle.sh"
bundled = re.findall(BUNDLED, bundle.read_text())
needed.update({package: bundle for package in bundled})
faults = [] if bundled else [f"{bundle} pairs no library with a package: is the expression right?"]
for file in list_files(root):
    if file.name == "CMakeLists.txt" or file.suffix == ".cmake":
        for name in re.findall(r"find_(?:package|library|path)\(\s*(\w+)", file.read_text()):
            if name not in PACKAGES:
                faults.append(f"{file}: tests/layout/check_packages.py does not know the Debian package of {name}")
            needed.update({package: file for package in PACKAGES.get(name, [])})
faults += [f"tools/packages.txt lacks {package}, needed by {user}" for package, user in needed.items() if package not in listed]
finish(faults)
