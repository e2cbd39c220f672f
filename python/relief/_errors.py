"""The exception of everything that Relief itself finds wrong."""
from __future__ import annotations

from typing import Sequence


class Error(Exception):
    """What is wrong, where, and what helps. `str(error)` is "WHERE: MESSAGE (HINT)".

    kind: "usage", "bad_input", "device_missing", "out_of_memory" or "failed".
    message: one sentence without a full stop.
    where: file, object, place or keyword; may be empty.
    hint: what can be done; may be empty.
    further: mistakes that were found together with the first, as tuples of message, where and hint."""

    def __init__(self, message: str, *, kind: str = "usage", where: str = "", hint: str = "",
                 further: Sequence[tuple[str, str, str]] = ()) -> None:
        self.message = message
        self.kind = kind
        self.where = where
        self.hint = hint
        self.further = list(further)
        super().__init__(message)

    def __str__(self) -> str:
        text = f"{self.where}: {self.message}" if self.where else self.message
        return f"{text} ({self.hint})" if self.hint else text

    def __reduce__(self) -> tuple[object, ...]:
        return _make_error, (self.message, self.kind, self.where, self.hint, self.further)


def _make_error(message: str, kind: str, where: str, hint: str, further: list[tuple[str, str, str]]) -> Error:
    return Error(message, kind=kind, where=where, hint=hint, further=further)
