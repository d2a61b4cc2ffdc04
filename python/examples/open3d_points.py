#!/usr/bin/env python3
"""Writes the coloured points of the first frame set of a take as points.ply, for Open3D.

    open3d_points.py take.mkv
    python3 -c "import open3d as o3d; o3d.visualization.draw(o3d.io.read_point_cloud('points.ply'))"
"""

import sys

import numpy as np

import vantage


def write_ply(path, positions, colours):
    """Positions (n, 3) in metres and colours (n, 3) of uint8 as binary PLY."""
    points = np.empty(
        len(positions),
        [("at", "<f4", 3), ("rgb", "u1", 3)],
    )
    points["at"], points["rgb"] = positions, colours
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property float {axis}" for axis in "xyz"]
    header += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    with open(path, "wb") as file:
        file.write(("\n".join(header + ["end_header"]) + "\n").encode())
        file.write(points.tobytes())


if __name__ == "__main__":
    with vantage.Take(sys.argv[1]) as take:
        positions, colours = take[0].points()
    write_ply("points.ply", positions, colours)
    print(f"points.ply: {len(positions)} points")
