"""What goes wrong while a scene is taken over or rendered, as one line for the user."""
import os
import traceback
from contextlib import contextmanager

import relief

from .node_tree import NotExpressible


@contextmanager
def place(kind, name):
    """What goes wrong inside is told with the thing that was being taken over."""
    try:
        yield
    except Exception as fault:
        fault.add_note(f'{kind} "{name}"' if name else kind)
        raise


def describe(fault):
    """Where, what, and a hint. What nobody foresaw has its type and line, and its traceback in the console."""
    places = ", ".join(reversed(getattr(fault, "__notes__", [])))
    return f"Relief: {places}: {_explain(fault)}" if places else f"Relief: {_explain(fault)}"


def _explain(fault):
    if isinstance(fault, (relief.Error, NotExpressible)):
        return str(fault)
    if isinstance(fault, MemoryError):
        return "there is not enough memory (smaller images or fewer subdivisions take less)"
    if isinstance(fault, OSError):
        return str(fault)
    traceback.print_exception(fault)
    frames = traceback.extract_tb(fault.__traceback__)
    line = f", {os.path.basename(frames[-1].filename)}:{frames[-1].lineno}" if frames else ""
    return f"{type(fault).__name__}: {fault} (a fault of the add-on{line}: the console has more)"
