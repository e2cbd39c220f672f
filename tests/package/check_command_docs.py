"""The manual page names every verb and exit status; the completions hold every verb and option of the command.

check_command_docs.py SOURCE RELIEF
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

source, relief = pathlib.Path(sys.argv[1]), sys.argv[2]
faults = []


def print_help(*verb):
    return subprocess.run([relief, *verb, "--help"], capture_output=True, text=True, check=True).stdout


verbs = re.findall(r"^  (\w+)", print_help().partition("Subcommands:")[2], re.M)
if "render" not in verbs:
    raise SystemExit("no verbs found in the help text")
farm_verbs = re.findall(r"^  (\w+)", print_help("farm").partition("Subcommands:")[2], re.M)
page = (source / "docs/man/relief.1").read_text()
faults += [f"relief.1 lacks the verb {verb}" for verb in verbs if f".It Cm {verb} " not in page and f".It Cm {verb}\n" not in page]
farm_line = re.search(r"^\.It Cm farm (.*)$", page, re.M)[1].split(" | ")
if "plan" not in farm_verbs or sorted(farm_line) != sorted(farm_verbs):
    faults.append(f"relief.1 has the verbs {farm_line} of farm, not {farm_verbs}")
codes = re.findall(r"\w+ = (\d+)", (source / "include/relief/error.h").read_text())
codes += re.findall(r"= (\d+)", (source / "apps/common/exit_codes.h").read_text())
status = page.partition(".Sh EXIT STATUS")[2]
faults += [f"relief.1 lacks the exit status {code}" for code in codes if not re.search(rf"^\.It .*\b{code}\b", status, re.M)]

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.executable, source / "cmake/make_completions.py", relief, folder], check=True)
    texts = {path.name: path.read_text() for path in pathlib.Path(folder).iterdir()}
    if len(texts) != 3:
        faults.append(f"completions: {sorted(texts)}")
    for verb in verbs:
        options = set(re.findall(r"(?<![\w-])(?:--[a-z][\w-]*|-[a-z])(?![\w-])",
                                 "\n".join(re.findall(r"^  (-\S+)", print_help(verb), re.M))))
        for option in options:
            fish = f"-l {option[2:]} " if option.startswith("--") else f"-s {option[1:]} "
            lines = {"relief": [line for line in texts["relief"].splitlines() if line.strip().startswith(f"{verb})")],
                     "_relief": [line for line in texts["_relief"].splitlines() if line.strip().startswith(f"{verb})")],
                     "relief.fish": [line for line in texts["relief.fish"].splitlines() if f"from {verb}'" in line]}
            for name, wanted in (("relief", option), ("_relief", f"{option}["), ("relief.fish", fish)):
                if not any(wanted in line for line in lines[name]):
                    faults.append(f"{name}: {verb} lacks {option}")
    for shell, file, flag in (("bash", "relief", "-n"), ("zsh", "_relief", "-n"), ("fish", "relief.fish", "-n")):
        if shutil.which(shell):
            faults += [shell] if subprocess.run([shell, flag, f"{folder}/{file}"]).returncode else []
    # Bash itself: what it offers after `relief render --bo`.
    script = (f"source {folder}/relief; COMP_WORDS=(relief render --bo); COMP_CWORD=2; _relief; echo ${{COMPREPLY[@]}}")
    offered = subprocess.run(["bash", "-c", script], capture_output=True, text=True).stdout.split()
    if sorted(offered) != ["--bottom", "--bottom-cache", "--bounce-levels", "--bounces"]:
        faults.append(f"bash offers {offered} for `relief render --bo`")
    for words, number, wanted in (("relief farm m", 2, ["merge"]), ("relief farm plan --ti", 3, ["--tiles"])):
        script = f"source {folder}/relief; COMP_WORDS=({words}); COMP_CWORD={number}; _relief; echo ${{COMPREPLY[@]}}"
        offered = subprocess.run(["bash", "-c", script], capture_output=True, text=True).stdout.split()
        if offered != wanted:
            faults.append(f"bash offers {offered} for `{words}`")
for fault in faults:
    print(fault)
raise SystemExit(1 if faults else 0)
