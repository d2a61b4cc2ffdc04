import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, overload

import numpy as np
import numpy.typing as npt

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

class VantageError(RuntimeError): ...

class View:
    rig: str
    K: npt.NDArray[np.float64]
    world_from_camera: npt.NDArray[np.float64]
    baseline_m: float
    doffs_px: float
    exposure_tai_ns: int
    calibration: str
    size: tuple[int, int]
    @property
    def rgba(self) -> npt.NDArray[np.uint8]: ...
    @property
    def colour(self) -> npt.NDArray[np.uint8]: ...
    @property
    def has_disparity(self) -> bool: ...
    @property
    def disparity_steps(self) -> npt.NDArray[np.uint16]: ...
    @property
    def disparity_scale(self) -> float: ...
    @property
    def disparity(self) -> npt.NDArray[np.float32]: ...
    @property
    def depth(self) -> npt.NDArray[np.float32]: ...
    @property
    def depth_K(self) -> npt.NDArray[np.float64]: ...
    def points(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]: ...

class FrameSet(Sequence[View]):
    pulse: int
    timecode: str
    damaged: list[str]
    decoding_s: float
    @property
    def rigs(self) -> list[str]: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, key: int | str) -> View: ...
    @overload
    def __getitem__(self, key: slice) -> list[View]: ...
    def points(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]: ...

@dataclass(frozen=True)
class CameraTicks:
    tick: npt.NDArray[np.int64]
    pulse: npt.NDArray[np.int64]
    time_s: npt.NDArray[np.float64]
    world_from_camera: npt.NDArray[np.float64]
    field_of_view_rad: npt.NDArray[np.float64]
    focus_m: npt.NDArray[np.float64]

class Take(Sequence[FrameSet]):
    path: Path
    rigs: list[str]
    pulses: npt.NDArray[np.int64]
    pulse_rate_hz: float
    timecode: str
    tai_offset_s: int
    ticks: int
    def __init__(self, path: str | os.PathLike[str]) -> None: ...
    def at(self, pulse: int) -> FrameSet: ...
    def cameras(self) -> CameraTicks: ...
    def close(self) -> None: ...
    def __enter__(self) -> Take: ...
    def __exit__(self, *exception: object) -> None: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int) -> FrameSet: ...
    @overload
    def __getitem__(self, index: slice) -> list[FrameSet]: ...
    def __iter__(self) -> Iterator[FrameSet]: ...

@dataclass
class Camera:
    width: int
    height: int
    K: npt.ArrayLike
    world_from_camera: npt.ArrayLike
    @classmethod
    def with_field_of_view(
        cls, width: int, height: int, field_of_view_rad: float, world_from_camera: npt.ArrayLike
    ) -> Camera: ...

def match(
    left: Any,
    right: Any,
    disparities: int = 64,
    preset: str = "balanced",
    matcher: str | None = None,
    fill: bool = True,
) -> npt.NDArray[np.float32]: ...
def render(views: Any, camera: Camera, synth: str | None = None) -> npt.NDArray[np.uint8]: ...
