"""No source file above 500 lines: who needs more has two ideas in one file."""
import sys

from sources import CODE, SCRIPTS, finish, list_files

LIMIT = 500

faults = []
for file in list_files(sys.argv[1]):
    if file.suffix in CODE | SCRIPTS or file.name in ("CMakeLists.txt", "Makefile"):
        lines = len(file.read_text().splitlines())
        if lines > LIMIT:
            faults.append(f"{file}: {lines} lines, {LIMIT} are allowed")
finish(faults)
