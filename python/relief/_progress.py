"""Progress on the terminal: tqdm where it is installed, else a line."""
from __future__ import annotations

import importlib
import sys
from types import TracebackType
from typing import Any, Callable, Optional, Union

from . import _relief
from ._arguments import is_false, is_bool

Callback = Callable[[_relief.Progress], Any]


class ProgressLine:
    """A callback of render(), within a `with` block that ends its line."""

    def __init__(self) -> None:
        self._bar: Any = None
        self._has_line = False
        try:
            tqdm = importlib.import_module("tqdm.auto").tqdm
        except ImportError:
            return
        self._bar = tqdm(total=100, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}")

    def __call__(self, progress: _relief.Progress) -> None:
        percent = 100 * progress.fraction
        if self._bar is not None:
            self._bar.n = round(percent, 1)
            self._bar.refresh()
            return
        self._has_line = True
        sys.stderr.write(f"\rrelief: {percent:5.1f} %  {progress.samples_done}/{progress.samples_total} samples")
        sys.stderr.flush()

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], value: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._has_line:
            sys.stderr.write("\n")


class NoProgress:
    """In place of a line: the callback that was given, or none."""

    def __init__(self, callback: Optional[Callback]) -> None:
        self._callback = callback

    def __enter__(self) -> Optional[Callback]:
        return self._callback

    def __exit__(self, *ignored: object) -> None:
        return None


def open_progress(progress: Union[bool, Callback, None]) -> Union[ProgressLine, NoProgress]:
    if progress is None or is_bool(progress):
        return ProgressLine() if progress else NoProgress(None)
    if not callable(progress):
        raise TypeError(f"progress: {progress!r} is neither True nor a function")
    function = progress
    return NoProgress(lambda made: not is_false(function(made)))
