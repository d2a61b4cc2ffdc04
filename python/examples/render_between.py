#!/usr/bin/env python3
"""Renders a view between the first two rigs of a take, and matches its picture as an example.

    render_between.py take.mkv
"""

import sys

import numpy as np
from PIL import Image

import vantage

if __name__ == "__main__":
    with vantage.Take(sys.argv[1]) as take:
        frames = take[0]
    a, b = frames[0], frames[-1]
    pose = a.world_from_camera.copy()
    pose[:3, 3] = (a.world_from_camera[:3, 3] + b.world_from_camera[:3, 3]) / 2
    picture = vantage.render(frames, vantage.Camera(*a.size, a.K, pose))
    Image.fromarray(picture).save("between.png")
    print(f"between.png: {np.mean(picture[..., 3] == 255):.0%} of the picture is covered")
