"""The pages of the documentation: their commands, links and options."""
import pathlib
import re

FOLDERS_OF_PAGES = (".", "docs", "docs/structures", "docs/decisions", "docs/results")


def list_pages(root: pathlib.Path) -> list[pathlib.Path]:
    return [page for folder in FOLDERS_OF_PAGES for page in sorted((root / folder).glob("*.md"))]


def split_blocks(text: str) -> tuple[list[list[str]], str]:
    """Code blocks, indented or fenced, as lists of their lines, and the text around them."""
    blocks, prose, block, fence = [], [], [], False
    for line in text.splitlines():
        is_indented = line.startswith("    ") and (bool(block) or not prose or not prose[-1].strip())
        if line.lstrip().startswith("```"):
            fence = not fence
        elif fence or is_indented:
            block.append(line if fence else line[4:])
            continue
        if block:
            blocks.append(block)
            block = []
        prose.append(line)
    return blocks + ([block] if block else []), "\n".join(prose)


def find_commands(text: str) -> list[str]:
    """Lines of code blocks that begin with `relief`, comments cut off, lines that end in a backslash joined."""
    commands = []
    for block in split_blocks(text)[0]:
        joined = "\n".join(block).replace("\\\n", " ")
        for line in joined.splitlines():
            line = re.sub(r"\s+#\s.*$", "", line.strip()).removeprefix("$ ")
            if re.match(r"relief\s", line):
                commands.append(line)
    return commands


def find_scenes(text: str) -> list[str]:
    """Whole scene files among the code blocks."""
    blocks = ["\n".join(block) for block in split_blocks(text)[0]]
    return [block for block in blocks if block.startswith("{") and '"version"' in block]


def find_make_targets(text: str) -> list[str]:
    lines = [line for block in split_blocks(text)[0] for line in block]
    found = [word for line in lines for word in re.findall(r"(?:^|[\s,`])make ([a-z-]+)", line.split("#")[0])]
    return found + re.findall(r"`make ([a-z-]+)", text)


def find_links(text: str) -> list[str]:
    """Targets of links and images within the repository."""
    targets = re.findall(r"\]\(([^)\s]+)\)", split_blocks(text)[1])
    return [t for t in targets if not re.match(r"[a-z]+:", t)]


def find_anchors(text: str) -> set[str]:
    headings = re.findall(r"(?m)^#+\s+(.*)$", split_blocks(text)[1])
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def find_options(text: str) -> set[str]:
    """Options of `relief` that code in the text names, outside of blocks."""
    spans = re.findall(r"`([^`]*)`", split_blocks(text)[1])
    ours = [span for span in spans if not re.match(r"(cmake|ctest|make|pkg-config|apt|git|iconvert|gltf)", span)]
    return {option for span in ours for option in re.findall(r"(?<![\w-])--[a-z][a-z0-9-]*", span)}
