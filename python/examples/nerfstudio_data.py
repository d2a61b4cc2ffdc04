#!/usr/bin/env python3
"""Writes a frame set as a data set for nerfstudio: nerfstudio/transforms.json, the pictures, depth
maps in millimetres, and a point cloud.

    nerfstudio_data.py take.mkv
    ns-train depth-nerfacto --data nerfstudio

`vantage take export --as training` writes the same for all frame sets.
"""

import json
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import vantage
from gsplat_training import frame_of
from open3d_points import write_ply

if __name__ == "__main__":
    folder = Path("nerfstudio")
    for name in ("images", "depth"):
        (folder / name).mkdir(parents=True)
    with vantage.Take(sys.argv[1]) as take:
        frames = take[0]
    transforms = {"camera_model": "OPENCV", "ply_file_path": "points.ply", "frames": []}
    for view in frames:
        frame = frame_of(view, folder)
        if view.has_disparity:
            # 0 is unknown; the map is brought to the size of the picture.
            millimetres = np.nan_to_num(1000 * view.depth, nan=0).clip(0, 65535).astype(np.uint16)
            frame["depth_file_path"] = f"depth/{view.rig}.png"
            Image.fromarray(millimetres).resize(view.size, Image.Resampling.NEAREST).save(
                folder / frame["depth_file_path"]
            )
        transforms["frames"].append(frame)
    positions, colours = frames.points()
    write_ply(folder / "points.ply", positions[::4], colours[::4])
    (folder / "transforms.json").write_text(json.dumps(transforms, indent=1))
    print(f"{folder}: {len(frames)} pictures, {len(positions[::4])} points")
