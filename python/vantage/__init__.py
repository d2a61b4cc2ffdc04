"""Takes of Vantage as NumPy arrays, and its matcher and renderer as functions.

A take is a recording of all rigs of a stage. The module reads takes, matches rectified pairs and
renders new views with the programs of the packages vantage and vantage-rig, which it starts.

Conventions: cameras have x right, y down, z forward, and pixel centres at integer coordinates. The
world is right-handed, in metres, with y up. Poses are named for what they map:
``world_from_camera``. Disparity is left-referenced and positive, in pixels.

    >>> import vantage
    >>> with vantage.Take("take.mkv") as take:
    ...     frames = take[0]
    ...     left = frames["left"]
    ...     print(left.colour.shape, left.depth.shape)
"""

from ._programs import VantageError
from ._stereo import match
from ._synthesis import Camera, render
from ._take import CameraTicks, FrameSet, Take, View

__all__ = [
    "Camera",
    "CameraTicks",
    "FrameSet",
    "Take",
    "VantageError",
    "View",
    "match",
    "render",
]
