"""The zip: what Blender needs to install it."""
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest
import zipfile

HERE = pathlib.Path(__file__).resolve().parent


class Addon(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())

    def pack(self, *names):
        for name in names:
            (self.folder / name).write_bytes(b"a wheel")
        return subprocess.run([sys.executable, HERE.parent / "make_addon.py", *(self.folder / n for n in names), "-o",
                               self.folder / "out"], capture_output=True, text=True)

    def test_the_manifest_lists_the_wheels_and_all_modules_are_there(self):
        wheels = ["relief-0.7.2-cp311-cp311-manylinux_2_34_x86_64.whl", "relief-0.7.2-cp312-abi3-manylinux_2_34_x86_64.whl"]
        self.assertEqual(self.pack(*wheels).returncode, 0)
        with zipfile.ZipFile(self.folder / "out" / "relief_blender-0.7.2.zip") as archive:
            manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
            names = archive.namelist()
        self.assertEqual(manifest["version"], "0.7.2")
        self.assertEqual(manifest["platforms"], ["linux-x64"])
        self.assertEqual(manifest["wheels"], [f"./wheels/{name}" for name in wheels])
        self.assertLessEqual({f"wheels/{name}" for name in wheels}, set(names))
        modules = {file.name for file in (HERE.parent / "relief_blender").glob("*.py")}
        self.assertLessEqual(modules, set(names))
        self.assertLess(len(manifest["permissions"]["files"]), 65)

    def test_a_script_that_only_registers_it_ends(self):
        script = f"import sys; sys.path.insert(0, {str(HERE.parent)!r}); import bpy, relief_blender; relief_blender.register()"
        self.assertEqual(subprocess.run([sys.executable, "-c", script], capture_output=True, timeout=120).returncode, 0)

    def test_a_script_that_enables_it_ends_without_a_word(self):
        """Blender itself unregisters what is enabled, after Python has."""
        script = (f"import sys; sys.path.insert(0, {str(HERE.parent)!r}); import bpy, addon_utils; "
                  "addon_utils.enable('relief_blender', default_set=True)")
        answer = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120)
        self.assertEqual(answer.returncode, 0)
        self.assertNotIn("Traceback", answer.stdout + answer.stderr)

    def test_what_is_no_wheel_of_a_platform_is_refused(self):
        answer = self.pack("relief-0.7.2-py3-none-any.whl")
        self.assertNotEqual(answer.returncode, 0)
        self.assertIn("no wheel", answer.stderr)

    def test_wheels_of_two_versions_are_refused(self):
        answer = self.pack("relief-0.7.2-cp311-cp311-manylinux_2_34_x86_64.whl",
                           "relief-0.7.3-cp311-cp311-manylinux_2_34_x86_64.whl")
        self.assertIn("several versions", answer.stderr)


if __name__ == "__main__":
    unittest.main()
