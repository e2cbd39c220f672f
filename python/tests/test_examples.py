"""The examples run, and mypy finds their types and those of the package right."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import relief

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples/python").glob("*.py"))


class ExamplesTest(unittest.TestCase):
    def test_each_of_five_runs(self):
        self.assertEqual(len(EXAMPLES), 5)
        package = str(pathlib.Path(relief.__file__).parents[1])
        for example in EXAMPLES:
            with self.subTest(example.name), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([sys.executable, "-B", example], cwd=folder, capture_output=True, text=True,
                                      env=dict(os.environ, PYTHONPATH=package), timeout=600)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                print(done.stdout, end="")
                made = [file.name for file in pathlib.Path(folder).iterdir()]
                if example.name in ("first_picture.py", "paint_map.py"):
                    self.assertEqual(made, [example.stem + ".png"])

    def test_the_lines_of_the_readme_end_with_a_picture(self):
        for page in (ROOT / "README.md", ROOT / "docs/python.md"):
            blocks = [block.split("```")[0] for block in page.read_text().split("```python\n")[1:]]
            self.assertTrue(blocks, page)
            with tempfile.TemporaryDirectory() as folder:
                script = "\n".join(blocks)
                done = subprocess.run([sys.executable, "-B", "-c", script], cwd=folder, capture_output=True, text=True, timeout=600)
                self.assertEqual(done.returncode, 0, f"{page}: {done.stderr}")
                self.assertTrue(list(pathlib.Path(folder).glob("*.png")), page)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_types_are_strict(self):
        package = pathlib.Path(relief.__file__).parent
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", folder, *EXAMPLES,
                                   *package.glob("_*.py"), package / "trees.py"], capture_output=True, text=True,
                                  env=dict(os.environ, MYPYPATH=str(package.parent)), timeout=600)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
