"""Formulas of Blender's nodes Mix, Math and Vector Math, on arrays whose last axis has three channels."""
import numpy as np


def _safe_divide(a, b):
    return np.where(b == 0, 0, a / np.where(b == 0, 1, b))


def _safe_power(a, b):
    whole = np.floor(b) == b
    return np.where((a >= 0) | whole, np.power(np.abs(a), b) * np.where((a < 0) & (np.mod(b, 2) == 1), -1, 1), 0)


def _overlay(f, a, b):
    low = a * (1 - f + 2 * f * b)
    high = 1 - (1 - f + 2 * f * (1 - b)) * (1 - a)
    return np.where(a < 0.5, low, high)


# Of factor, A and B.
BLENDS = {
    "MIX": lambda f, a, b: a + f * (b - a),
    "MULTIPLY": lambda f, a, b: a * (1 - f + f * b),
    "ADD": lambda f, a, b: a + f * b,
    "SUBTRACT": lambda f, a, b: a - f * b,
    "SCREEN": lambda f, a, b: 1 - (1 - f + f * (1 - b)) * (1 - a),
    "DIVIDE": lambda f, a, b: np.where(b == 0, a, (1 - f) * a + f * _safe_divide(a, b)),
    "DIFFERENCE": lambda f, a, b: a + f * (np.abs(a - b) - a),
    "DARKEN": lambda f, a, b: a + f * (np.minimum(a, b) - a),
    "LIGHTEN": lambda f, a, b: np.maximum(a, a + f * (np.maximum(a, b) - a)),
    "OVERLAY": _overlay,
}

# Function and number of inputs.
MATH = {
    "ADD": (np.add, 2), "SUBTRACT": (np.subtract, 2), "MULTIPLY": (np.multiply, 2), "DIVIDE": (_safe_divide, 2),
    "MULTIPLY_ADD": (lambda a, b, c: a * b + c, 3), "POWER": (_safe_power, 2),
    "SQRT": (lambda a: np.sqrt(np.maximum(a, 0)), 1), "ABSOLUTE": (np.abs, 1), "EXPONENT": (np.exp, 1),
    "MINIMUM": (np.minimum, 2), "MAXIMUM": (np.maximum, 2), "SIGN": (np.sign, 1),
    "LESS_THAN": (lambda a, b: np.where(a < b, 1.0, 0.0), 2),
    "GREATER_THAN": (lambda a, b: np.where(a > b, 1.0, 0.0), 2),
    "ROUND": (lambda a: np.floor(a + 0.5), 1), "FLOOR": (np.floor, 1), "CEIL": (np.ceil, 1),
    "FRACT": (lambda a: a - np.floor(a), 1), "SINE": (np.sin, 1), "COSINE": (np.cos, 1),
}

VECTOR_MATH = {
    "ADD": (np.add, 2), "SUBTRACT": (np.subtract, 2), "MULTIPLY": (np.multiply, 2), "DIVIDE": (_safe_divide, 2),
    "MULTIPLY_ADD": (lambda a, b, c: a * b + c, 3), "SCALE": (np.multiply, 2), "ABSOLUTE": (np.abs, 1),
    "MINIMUM": (np.minimum, 2), "MAXIMUM": (np.maximum, 2),
}


def _rgb_to_hsv(rgb):
    most, least = rgb.max(-1), rgb.min(-1)
    span = most - least
    safe = np.where(span == 0, 1, span)
    r, g, b = np.moveaxis(rgb, -1, 0)
    sector = np.where(most == r, np.mod((g - b) / safe, 6), np.where(most == g, (b - r) / safe + 2, (r - g) / safe + 4))
    return np.where(span == 0, 0, sector / 6), np.where(most == 0, 0, span / np.where(most == 0, 1, most)), most


def _hsv_to_rgb(hue, saturation, value):
    ways = [np.clip(np.abs(np.mod(hue * 6 + shift, 6) - 3) - 1, 0, 1) for shift in (0, 4, 2)]
    return np.stack([value * (1 - saturation * (1 - way)) for way in ways], -1)


def shift_hue(hue, saturation, value, factor, color):
    """The node Hue/Saturation/Value."""
    h, s, v = _rgb_to_hsv(color)
    h = np.mod(h + hue[..., 0] + 0.5, 1)
    shifted = _hsv_to_rgb(h, np.clip(s * saturation[..., 0], 0, 1), v * value[..., 0])
    return np.maximum(color + factor * (shifted - color), 0)
