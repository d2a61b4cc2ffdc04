#!/usr/bin/env python3
"""Writes a frame set as a data set for Gaussian splatting: gsplat/transforms.json, the pictures,
and a point cloud made from depth, from which training starts.

    gsplat_training.py take.mkv
    ns-train splatfacto --data gsplat       # or another trainer that reads transforms.json

`vantage take export --as training` writes the same with depth maps and a COLMAP model, for all
frame sets.
"""

import json
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import vantage
from open3d_points import write_ply

# OpenGL's camera axes: y up and z backward.
GL_AXES = np.diag([1.0, -1.0, -1.0, 1.0])

def frame_of(view, folder):
    """Saves the picture of a view in FOLDER/images. Returns its entry of `transforms.json`."""
    name = f"images/{view.rig}.png"
    Image.fromarray(np.ascontiguousarray(view.colour)).save(folder / name)
    return {
        "file_path": name,
        "w": view.size[0],
        "h": view.size[1],
        "fl_x": view.K[0, 0],
        "fl_y": view.K[1, 1],
        # The corner of the picture is at (0, 0), and the first pixel half a pixel further.
        "cx": view.K[0, 2] + 0.5,
        "cy": view.K[1, 2] + 0.5,
        "transform_matrix": (view.world_from_camera @ GL_AXES).tolist(),
    }


if __name__ == "__main__":
    folder = Path("gsplat")
    (folder / "images").mkdir(parents=True)
    with vantage.Take(sys.argv[1]) as take:
        frames = take[0]
    transforms = {"camera_model": "OPENCV", "ply_file_path": "points.ply"}
    transforms["frames"] = [frame_of(view, folder) for view in frames]
    positions, colours = frames.points()
    write_ply(folder / "points.ply", positions[::4], colours[::4])
    (folder / "transforms.json").write_text(json.dumps(transforms, indent=1))
    print(f"{folder}: {len(frames)} pictures, {len(positions[::4])} points")
