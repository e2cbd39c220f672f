"""Writes completions of the shells from what the command says of itself: its verbs, their options and their choices.

make_completions.py RELIEF FOLDER: FOLDER/relief (bash), FOLDER/_relief (zsh), FOLDER/relief.fish.
"""
import pathlib
import re
import subprocess
import sys


def read_help(program, *verb):
    """The lines `NAMES[ PLACEHOLDER][...]   description` of a help text, by the heading that they stand under."""
    text = subprocess.run([program, *verb, "--help-all" if verb else "--help"], capture_output=True, text=True, check=True).stdout
    heading, lines = "", []
    for line in text.splitlines():
        if line.endswith(":") and not line.startswith(" "):
            heading = line[:-1]
        found = re.match(r"  (\S.*?)(?:  +(\S.*))?$", line)
        if found and heading:
            lines.append((heading, found[1], found[2] or ""))
    return lines


def list_verbs(program):
    return {name: text for heading, name, text in read_help(program) if heading == "Subcommands"}


def list_options(program, *verb):
    """(names, takes a value, description) of each option."""
    options = []
    for _, entry, text in read_help(program, *verb):
        if entry.startswith("-"):
            words = entry.split()
            names = words[0].split(",")
            takes_value = len(words) > 1 and words[1] != "Excludes:"
            options.append((names, takes_value, text))
    return options


def quote(text):
    return "'" + text.replace("'", "'\\''") + "'"


def write_bash(verbs, options):
    cases = "".join(f"    {verb}) words={quote(' '.join(n for names, _, _ in options[verb] for n in names))} ;;\n" for verb in verbs)
    return f"""# bash completion of relief
_relief() {{
  local words current=${{COMP_WORDS[COMP_CWORD]}}
  case ${{COMP_CWORD}}:${{COMP_WORDS[1]}} in
    1:*) words={quote(' '.join(verbs) + ' --help --version')} ;;
    *) case ${{COMP_WORDS[1]}} in
{cases}    esac ;;
  esac
  if [[ $COMP_CWORD == 1 || $current == -* ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}}
complete -o bashdefault -o default -F _relief relief
"""


def write_zsh(verbs, options):
    def describe(text):
        return re.sub(r"([\[\]:\\])", r"\\\1", text)

    cases = ""
    for verb in verbs:
        specs = [quote(f"{name}[{describe(text)}]" + (":value:_files" if value else ""))
                 for names, value, text in options[verb] for name in names]
        cases += f"    {verb}) _arguments {' '.join(specs)} '*:file:_files' ;;\n"
    names = " ".join(quote(f"{verb}:{describe(text)}") for verb, text in verbs.items())
    return f"""#compdef relief
local -a verbs
verbs=({names})
if (( CURRENT == 2 )); then
  _describe verb verbs
  _arguments '--help[print a help text]' '--version[print the version]'
else
  local verb=$words[2]
  shift words
  (( CURRENT-- ))
  case $verb in
{cases}  esac
fi
"""


def write_fish(verbs, options):
    lines = ["# fish completion of relief", "complete -c relief -n __fish_use_subcommand -l help -d 'print a help text'",
             "complete -c relief -n __fish_use_subcommand -l version -d 'print the version'"]
    for verb, text in verbs.items():
        lines.append(f"complete -c relief -n __fish_use_subcommand -f -a {verb} -d {quote(text)}")
        for names, value, description in options[verb]:
            flags = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in names)
            lines.append(f"complete -c relief -n '__fish_seen_subcommand_from {verb}' {flags}{' -r' if value else ''} "
                         f"-d {quote(description)}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    relief, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    all_verbs = list_verbs(relief)
    all_options = {verb: list_options(relief, verb) for verb in all_verbs}
    folder.mkdir(parents=True, exist_ok=True)
    for name, write in (("relief", write_bash), ("_relief", write_zsh), ("relief.fish", write_fish)):
        (folder / name).write_text(write(all_verbs, all_options))
