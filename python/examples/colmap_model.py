#!/usr/bin/env python3
"""Writes a frame set as a COLMAP model: colmap/images and colmap/sparse/0 with the rigs' cameras and
poses, and points made from depth.

    colmap_model.py take.mkv
    colmap gui --import_path colmap/sparse/0 --image_path colmap/images

`vantage take export --as training` writes the same for all frame sets.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

import vantage


def quaternion(rotation):
    """(w, x, y, z) of a (3, 3) rotation."""
    m = rotation
    # The eigenvector of this symmetric matrix with the largest eigenvalue is the quaternion.
    K = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], 0, 0, 0],
            [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], 0, 0],
            [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], 0],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)],
        ]
    )
    x, y, z, w = np.linalg.eigh(K)[1][:, -1]
    return np.array([w, x, y, z]) * (1 if w >= 0 else -1)


if __name__ == "__main__":
    folder = Path("colmap")
    model = folder / "sparse" / "0"
    model.mkdir(parents=True)
    (folder / "images").mkdir()
    with vantage.Take(sys.argv[1]) as take:
        frames = take[0]
    cameras, images, points = [], [], []
    for number, view in enumerate(frames, 1):
        Image.fromarray(np.ascontiguousarray(view.colour)).save(folder / "images" / f"{view.rig}.png")
        # In COLMAP the centre of the first pixel is at (0.5, 0.5).
        lens = [view.K[0, 0], view.K[1, 1], view.K[0, 2] + 0.5, view.K[1, 2] + 0.5]
        cameras.append([number, "PINHOLE", *view.size, *lens])
        camera_from_world = np.linalg.inv(view.world_from_camera)
        images.append(
            [number, *quaternion(camera_from_world[:3, :3]), *camera_from_world[:3, 3], number]
            + [f"{view.rig}.png\n"]  # followed by an empty list of its points
        )
    positions, colours = frames.points()
    for number, (at, colour) in enumerate(zip(positions[::4], colours[::4]), 1):
        points.append([number, *at, *colour, 0])
    for name, rows in (("cameras", cameras), ("images", images), ("points3D", points)):
        (model / f"{name}.txt").write_text("".join(" ".join(map(str, row)) + "\n" for row in rows))
    print(f"{folder}: {len(images)} pictures, {len(points)} points")
