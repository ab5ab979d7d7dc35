"""The background as a picture by latitude and longitude: the middle is -Z, what is right of it +X, rows go down from +Y."""

import exr
import numpy as np
from scene import Gradient, Image

# Texels for each of the picture's own. Odd, so that its centres are centres of texels again: what lies between is linear in both.
FINER = 9


def texels(background: Gradient | Image, rows_at_poles=False) -> np.ndarray:
    """Values that a program gets back by interpolating linearly between the centres of texels.

    Rows have their centres half a row from the poles; with `rows_at_poles` the first and the last lie at the poles.
    """
    if isinstance(background, Gradient):
        rows = 1024
        up = np.cos(np.pi * down(rows, rows_at_poles))[:, None]
        light = np.array(background.bottom) * (1 - up) / 2 + np.array(background.top) * (1 + up) / 2
        return np.repeat(light[:, None], 64, axis=1).astype(np.float32)
    picture = exr.read(background.file).astype(float)
    height, width, _ = picture.shape
    # With rows at the poles a fourth of a row from one to the next: the centres are among them.
    rows = 4 * height + 1 if rows_at_poles else FINER * height
    y = np.clip(down(rows, rows_at_poles) * height - 0.5, 0, height - 1)
    x = (np.arange(FINER * width) + 0.5) / FINER - 0.5
    return between(between(picture, y, 0), x, 1).astype(np.float32)


def down(rows, at_poles) -> np.ndarray:
    """Where rows lie, from 0 straight up to 1 straight down."""
    return np.arange(rows) / (rows - 1) if at_poles else (np.arange(rows) + 0.5) / rows


def between(values, places, axis) -> np.ndarray:
    """Values at places between whole numbers along an axis, which is closed to a ring."""
    count = values.shape[axis]
    low = np.floor(places).astype(int)
    share = np.expand_dims(places - low, 1 - axis)[..., None]
    first, second = (np.take(values, (low + i) % count, axis) for i in (0, 1))
    return first * (1 - share) + second * share
