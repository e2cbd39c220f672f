"""Arrays of callers as the extension takes them, or exceptions that name the argument and its shape."""
from __future__ import annotations

import os
from typing import Any, Optional

import numpy as np

Array = np.ndarray[Any, Any]

TEXEL_TYPES = ("uint8", "uint16", "float16", "float32")


def is_array(value: object) -> bool:
    """Of NumPy, or of another library that speaks DLPack or NumPy's protocols."""
    return isinstance(value, np.ndarray) or hasattr(value, "__dlpack__") or hasattr(value, "__array_interface__")


def to_numpy(value: Any, name: str) -> Array:
    """Without a copy where the memory is the processor's."""
    if isinstance(value, np.ndarray):
        return value
    if hasattr(value, "__dlpack__"):
        try:
            return np.from_dlpack(value)
        except (TypeError, RuntimeError, BufferError, ValueError):
            pass  # read-only memory, which older versions of NumPy do not take by DLPack
    try:
        return np.asarray(value)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name}: {error}") from None


def as_path(value: Any, name: str, wanted: str) -> str:
    """wanted: what may stand there, for the message."""
    if not isinstance(value, (str, os.PathLike)):
        shown = describe(value) if isinstance(value, np.ndarray) else type(value).__name__
        raise TypeError(f"{name}: {wanted} is needed, not {shown}")
    return os.fspath(value)


def describe(array: Array) -> str:
    return f"{array.dtype} {array.shape}"


def check_finite(array: Array, name: str) -> None:
    if not np.isfinite(array).all():
        row = int(np.argwhere(~np.isfinite(array))[0][0])
        raise ValueError(f"{name}: NaN or infinity in row {row}")


def as_floats(value: Any, name: str, width: Optional[int]) -> Array:
    """(N, width), or (N,) where width is None; float32. Other kinds of numbers and orders of memory are copied."""
    array = to_numpy(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: numbers are needed, not {describe(array)}")
    wanted = "(N,)" if width is None else f"(N, {width})"
    if array.ndim != (1 if width is None else 2) or (width is not None and array.shape[1] != width):
        raise ValueError(f"{name}: the shape is {array.shape}, not {wanted}")
    return np.ascontiguousarray(array, dtype=np.float32)


def as_indices(value: Any, name: str, count: int) -> Array:
    """(N,) uint32, each below `count`. Other kinds of integers are copied."""
    array = to_numpy(value, name)
    if array.size == 0:
        return np.zeros(0, np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name}: integers are needed, not {describe(array)}")
    if array.ndim != 1:
        raise ValueError(f"{name}: the shape is {array.shape}, not (N,)")
    low, high = int(array.min()), int(array.max())
    if low < 0 or high >= count:
        raise ValueError(f"{name}: index {low if low < 0 else high} is out of range: there are {count}")
    return np.ascontiguousarray(array, dtype=np.uint32)


def as_texels(value: Any, name: str) -> Array:
    """(H, W, C) of a type of texels, C from 1 to 4. float64 becomes float32, other orders of memory are copied."""
    array = to_numpy(value, name)
    if array.dtype == np.float64:
        array = array.astype(np.float32)
    if array.dtype.name not in TEXEL_TYPES:
        raise TypeError(f"{name}: texels are {', '.join(TEXEL_TYPES)} or float64, not {describe(array)}")
    if array.ndim == 2:
        array = array[:, :, np.newaxis]
    if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or array.size == 0:
        raise ValueError(f"{name}: the shape is {array.shape}, not (height, width) or (height, width, 1 to 4)")
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    return np.ascontiguousarray(array)
