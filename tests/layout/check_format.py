"""clang-format has nothing to change (`make format` does it)."""
import subprocess
import sys

from sources import finish, list_code

root, clang_format = sys.argv[1:]
files = [str(p) for p in list_code(root)]
result = subprocess.run([clang_format, "--dry-run", "--Werror", "--ferror-limit=1", *files], check=False)
finish([] if result.returncode == 0 else ["run `make format`"])
