"""What could not be taken over from Blender, each thing once."""


class Report:
    """Lines of the form: kind "name": text. `kind` is material, object, light, world, camera or scene."""

    def __init__(self):
        self._lines = {}

    def add(self, kind, name, text):
        self._lines.setdefault(f'{kind} "{name}": {text}' if name else f"{kind}: {text}")

    @property
    def lines(self):
        return list(self._lines)

    def __contains__(self, part):
        return any(part in line for line in self._lines)

    def tell(self, tell, shown=20):
        """Calls tell(line) for the first lines, and once for the number of the others."""
        for line in self.lines[:shown]:
            tell(line)
        if len(self._lines) > shown:
            tell(f"... and {len(self._lines) - shown} more: see the panel Relief Statistics")
