"""Reads and writes the pictures and maps that the programs exchange."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from ._programs import VantageError


def write_picture(path: Path, picture: npt.ArrayLike) -> None:
    """Writes a (h, w), (h, w, 3) or (h, w, 4) array of uint8 as PNG."""
    array = np.asarray(picture)
    if array.dtype != np.uint8 or array.ndim not in (2, 3) or array.shape[2:] not in ((), (3,), (4,)):
        raise VantageError(
            f"a picture is an array of uint8 of the shape (h, w), (h, w, 3) or (h, w, 4); this one "
            f"is of {array.dtype} and {array.shape}"
        )
    Image.fromarray(np.ascontiguousarray(array[..., :3] if array.ndim == 3 else array)).save(
        path, compress_level=1
    )


def picture_path(picture: Any, folder: Path, name: str) -> str:
    """The path of a picture that is given as one, or the path of a copy of an array."""
    if isinstance(picture, (str, os.PathLike)):
        return os.fspath(picture)
    path = folder / f"{name}.png"
    write_picture(path, picture)
    return str(path)


def read_picture(path: Path) -> npt.NDArray[np.uint8]:
    """(h, w, channels) of a PNG."""
    with Image.open(path) as image:
        return np.array(image)


def write_pfm(path: Path, values: npt.NDArray[Any]) -> None:
    """Writes a map of floats; what is not finite is unknown."""
    rows = np.asarray(values, dtype="<f4").copy()
    rows[~np.isfinite(rows)] = np.inf
    with open(path, "wb") as file:
        file.write(f"Pf\n{rows.shape[1]} {rows.shape[0]}\n-1.0\n".encode())
        file.write(np.flipud(rows).tobytes())


def read_pfm(path: Path) -> npt.NDArray[np.float32]:
    """(h, w) of a map of floats, NaN where it is unknown."""
    with open(path, "rb") as file:
        if file.readline().strip() != b"Pf":
            raise VantageError(f"{path} is no PFM of one channel")
        width, height = (int(number) for number in file.readline().split())
        order = "<f4" if float(file.readline()) < 0 else ">f4"
        rows = np.frombuffer(file.read(), order, width * height).reshape(height, width)
    values = np.flipud(rows).astype(np.float32)
    values[~np.isfinite(values)] = np.nan
    return values
