"""Writes completions of the shells from what the command says of itself: its verbs, their options and their choices.

make_completions.py RELIEF FOLDER: FOLDER/relief (bash), FOLDER/_relief (zsh), FOLDER/relief.fish.
"""
import pathlib
import re
import subprocess
import sys


def read_help(program, *verb, brief=False):
    """The lines `NAMES[ PLACEHOLDER][...]   description` of a help text, by the heading that they stand under."""
    text = subprocess.run([program, *verb, "--help-all" if verb and not brief else "--help"], capture_output=True, text=True, check=True).stdout
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


def list_inner_verbs(program, verb):
    """Those under a verb: `farm` has plan, submit and more."""
    return {name: text for heading, name, text in read_help(program, verb, brief=True) if heading == "Subcommands"}


def list_options(program, *verb, brief=False):
    """(names, takes a value, description) of each option."""
    options = []
    for _, entry, text in read_help(program, *verb, brief=brief):
        if entry.startswith("-"):
            words = entry.split()
            names = words[0].split(",")
            takes_value = len(words) > 1 and words[1] != "Excludes:"
            options.append((names, takes_value, text))
    return options


def quote(text):
    return "'" + text.replace("'", "'\\''") + "'"


def list_words(options, verb):
    return " ".join(name for names, _, _ in options[verb] for name in names)


def write_bash(verbs, inner, options):
    cases = "".join(f"    {verb}) words={quote(list_words(options, verb))} ;;\n" for verb in verbs if not inner[verb])
    for verb in filter(inner.get, verbs):
        under = "".join(f" {name}) words={quote(list_words(options, f'{verb} {name}'))} ;;" for name in inner[verb])
        first = " ".join([*inner[verb], list_words(options, verb)])
        cases += f"    {verb}) words={quote(first)}; inner=2; case ${{COMP_WORDS[2]}} in{under} esac ;;\n"
    return f"""# bash completion of relief
_relief() {{
  local words inner=0 current=${{COMP_WORDS[COMP_CWORD]}}
  case ${{COMP_CWORD}}:${{COMP_WORDS[1]}} in
    1:*) words={quote(' '.join(verbs) + ' --help --version')} ;;
    *) case ${{COMP_WORDS[1]}} in
{cases}    esac ;;
  esac
  if [[ $COMP_CWORD == 1 || $COMP_CWORD == "$inner" || $current == -* ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  fi
}}
complete -o bashdefault -o default -F _relief relief
"""


def write_zsh(verbs, inner, options):
    def describe(text):
        return re.sub(r"([\[\]:\\])", r"\\\1", text)

    def list_specs(verb):
        return " ".join(quote(f"{name}[{describe(text)}]" + (":value:_files" if value else ""))
                        for names, value, text in options[verb] for name in names)

    def list_names(some):
        return " ".join(quote(f"{verb}:{describe(text)}") for verb, text in some.items())

    cases = ""
    for verb in verbs:
        arguments = f"_arguments {list_specs(verb)} '*:file:_files'"
        if inner[verb]:
            under = " ".join(f"{name}) _arguments {list_specs(f'{verb} {name}')} '*:file:_files' ;;" for name in inner[verb])
            arguments = (f"if (( CURRENT == 2 )); then local -a names; names=({list_names(inner[verb])}); _describe verb names; "
                         f"{arguments}; else local name=$words[2]; shift words; (( CURRENT-- )); case $name in {under} esac; fi")
        cases += f"    {verb}) {arguments} ;;\n"
    return f"""#compdef relief
local -a verbs
verbs=({list_names(verbs)})
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


def write_fish(verbs, inner, options):
    lines = ["# fish completion of relief", "complete -c relief -n __fish_use_subcommand -l help -d 'print a help text'",
             "complete -c relief -n __fish_use_subcommand -l version -d 'print the version'"]

    def add_options(condition, verb):
        for names, value, description in options[verb]:
            flags = " ".join(f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}" for name in names)
            lines.append(f"complete -c relief -n '{condition}' {flags}{' -r' if value else ''} -d {quote(description)}")

    for verb, text in verbs.items():
        lines.append(f"complete -c relief -n __fish_use_subcommand -f -a {verb} -d {quote(text)}")
        seen = f"__fish_seen_subcommand_from {verb}"
        names = " ".join(inner[verb])
        add_options(seen, verb)
        for name, description in inner[verb].items():
            lines.append(f"complete -c relief -n '{seen}; and not __fish_seen_subcommand_from {names}' -f -a {name} "
                         f"-d {quote(description)}")
            add_options(f"{seen}; and __fish_seen_subcommand_from {name}", f"{verb} {name}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    relief, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    all_verbs = list_verbs(relief)
    all_inner = {verb: list_inner_verbs(relief, verb) if verb == "farm" else {} for verb in all_verbs}
    all_options = {}
    for verb, names in all_inner.items():
        # The long help of a verb with others under it is the help of all of them.
        all_options[verb] = list_options(relief, verb, brief=bool(names))
        for name in names:
            all_options[f"{verb} {name}"] = list_options(relief, verb, name)
    folder.mkdir(parents=True, exist_ok=True)
    for name, write in (("relief", write_bash), ("_relief", write_zsh), ("relief.fish", write_fish)):
        (folder / name).write_text(write(all_verbs, all_inner, all_options))
