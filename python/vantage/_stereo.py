"""Stereo matching of rectified pairs."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._files import picture_path, read_pfm
from ._programs import run


def match(
    left: Any,
    right: Any,
    disparities: int = 64,
    preset: str = "balanced",
    matcher: str | None = None,
    fill: bool = True,
) -> npt.NDArray[np.float32]:
    """Disparity of the left picture of a rectified pair, (h, w) in px, NaN where it is unknown.

    It is computed on the GPU by the shaders that a rig runs (``vantage-rig match``).

    left, right: (h, w), (h, w, 3) or (h, w, 4) arrays of uint8, or paths of pictures.
    disparities: number of candidate disparities, px.
    preset: "fast", "balanced" or "quality".
    matcher: name of a matcher; by default that of the preset.
    fill: whether pixels without a match are filled from their neighbours.
    """
    with tempfile.TemporaryDirectory(prefix="vantage-") as name:
        folder = Path(name)
        output = folder / "disparity.pfm"
        arguments = [
            "match",
            picture_path(left, folder, "left"),
            picture_path(right, folder, "right"),
            "--disparities",
            str(disparities),
            "--preset",
            preset,
            "--repeats",
            "1",
            "-o",
            str(output),
        ]
        if matcher is not None:
            arguments += ["--matcher", matcher]
        if not fill:
            arguments.append("--no-fill")
        run("vantage-rig", arguments)
        return read_pfm(output)
