"""View synthesis: pictures from cameras that do not exist."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable

import numpy as np
import numpy.typing as npt

from ._files import read_picture, write_pfm, write_picture
from ._programs import run
from ._take import View


@dataclass
class Camera:
    """A pinhole camera."""

    width: int
    """px"""
    height: int
    """px"""
    K: npt.ArrayLike
    """(3, 3) intrinsics, px."""
    world_from_camera: npt.ArrayLike
    """(4, 4) or (3, 4) pose, metres."""

    @classmethod
    def with_field_of_view(
        cls, width: int, height: int, field_of_view_rad: float, world_from_camera: npt.ArrayLike
    ) -> Camera:
        """A camera with this horizontal field of view and a centred principal point."""
        f = width / 2 / np.tan(field_of_view_rad / 2)
        K = [[f, 0, (width - 1) / 2], [0, f, (height - 1) / 2], [0, 0, 1]]
        return cls(width, height, K, world_from_camera)

    def _as_json(self) -> dict[str, Any]:
        return {
            "width": int(self.width),
            "height": int(self.height),
            "K": np.asarray(self.K, dtype=float).tolist(),
            "world_from_camera": np.asarray(self.world_from_camera, dtype=float)[:3].tolist(),
        }


def _write_view_set(folder: Path, views: Iterable[View]) -> None:
    documents = []
    for view in views:
        write_picture(folder / f"{view.rig}.png", view.colour)
        document: dict[str, Any] = {
            "name": view.rig,
            "image": f"{view.rig}.png",
            "K": view.K.tolist(),
            "world_from_camera": view.world_from_camera[:3].tolist(),
        }
        if view.has_disparity:
            write_pfm(folder / f"{view.rig}.pfm", view.depth)
            document["depth"] = f"{view.rig}.pfm"
        documents.append(document)
    (folder / "views.json").write_text(json.dumps({"version": 1, "views": documents}))


def render(views: Any, camera: Camera, synth: str | None = None) -> npt.NDArray[np.uint8]:
    """The picture of a new camera, (height, width, 4): R, G, B, and 255 where a view covers it.

    It is rendered on the GPU (``vantage render``).

    views: a FrameSet, a list of View, or the path of a view set's folder.
    camera: the camera to render.
    synth: name of a synthesiser; by default that of the programme.
    """
    with tempfile.TemporaryDirectory(prefix="vantage-") as name:
        folder = Path(name)
        if isinstance(views, (str, os.PathLike)):
            source = os.fspath(views)
        else:
            source = str(folder / "views")
            os.mkdir(source)
            _write_view_set(Path(source), views)
        pose = folder / "pose.json"
        pose.write_text(json.dumps(camera._as_json()))
        output = folder / "picture.png"
        arguments = ["render", "--views", source, "--pose", str(pose), "-o", str(output)]
        if synth is not None:
            arguments += ["--synth", synth]
        run("vantage", arguments)
        picture = read_picture(output)
        if picture.shape[2] == 4:
            return picture
        covered = np.full(picture.shape[:2] + (1,), 255, np.uint8)
        return np.concatenate([picture, covered], axis=2)
