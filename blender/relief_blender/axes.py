"""Blender has z up, Relief y up: (x, y, z) of Blender is (x, z, -y) of Relief. Objects keep their own axes."""
import numpy as np

RELIEF_FROM_BLENDER = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], float)
# Channels of a map of Blender's world axes, as axes of Relief's world.
WORLD_AXES = "x,-z,y"


def convert_matrix(matrix_world):
    """4x4 of Blender's world from an object -> Relief's world from the object."""
    return RELIEF_FROM_BLENDER @ np.array(matrix_world, float)


def convert_vector(vector):
    x, y, z = (float(v) for v in vector)
    return [x, z, -y]


def convert_back(array):
    """(..., 3) vectors of Relief -> of Blender."""
    array = np.asarray(array)
    return np.stack([array[..., 0], -array[..., 2], array[..., 1]], -1)


def find_axis_scale(matrix):
    """Lengths of the three axes of a 4x4 matrix."""
    return np.linalg.norm(np.array(matrix, float)[:3, :3], axis=0)
