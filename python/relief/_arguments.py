"""Arguments that Python reads, refused as the library refuses its own: an Error with the name, the value and what is wanted."""
from __future__ import annotations

import difflib
import operator
from typing import Any, NoReturn, Optional, Sequence

import numpy as np

from ._errors import Error

LONGEST = 60  # characters of a value in a message


def refuse(value: Any, name: str, wanted: str, hint: str = "") -> NoReturn:
    shown = repr(value)
    raise Error(f"{shown[:LONGEST] + '...' if len(shown) > LONGEST else shown} is not {wanted}", where=name, hint=hint)


def is_bool(value: Any) -> bool:
    return isinstance(value, (bool, np.bool_))


def is_false(answer: Any) -> bool:
    """Whether a callback has said False; None and numbers are no answer."""
    return is_bool(answer) and not answer


def as_bool(value: Any, name: str) -> bool:
    if not is_bool(value):
        refuse(value, name, "True or False")
    return bool(value)


def as_integer(value: Any, name: str, low: int, high: int) -> int:
    wanted = f"a whole number from {low} to {high}"
    if is_bool(value):
        refuse(value, name, wanted)
    try:
        number = operator.index(value)
    except TypeError:
        refuse(value, name, wanted)
    if not low <= number <= high:
        refuse(value, name, wanted)
    return number


def as_number(value: Any, name: str, low: float, high: float, wanted: Optional[str] = None) -> float:
    wanted = wanted or f"a number from {low:.12g} to {high:.12g}"
    if is_bool(value) or isinstance(value, (str, bytes)):
        refuse(value, name, wanted)
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        refuse(value, name, wanted)
    if not low <= number <= high:
        refuse(value, name, wanted)
    return number


def as_word(value: Any, name: str, words: Sequence[str]) -> str:
    if not isinstance(value, str) or value not in words:
        near = difflib.get_close_matches(value, words, 1) if isinstance(value, str) else []
        refuse(value, name, f"one of {', '.join(words)}", f"did you mean '{near[0]}'?" if near else "")
    return value
