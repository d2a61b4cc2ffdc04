"""Takes: recordings of all rigs of a stage."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from ._memory import SharedMemory
from ._programs import VantageError, find_program, last_sentence

_STEPS_PER_PX = 32
_forks = 0


def _note_fork() -> None:
    global _forks
    _forks += 1


os.register_at_fork(before=_note_fork)


def _release(released: list[int], number: int, forks: int) -> None:
    """Lets memory be used again, unless a process that was forked meanwhile may hold it too."""
    if forks == _forks:
        released.append(number)


class View:
    """What one rig saw at one pulse.

    The arrays ``colour``, ``rgba`` and ``disparity_steps`` share the memory that the frame was
    decoded into; they are read-only, and valid as long as they are held. ``disparity``, ``depth``
    and ``points`` are computed at their first use.
    """

    rig: str
    """Name of the rig."""
    K: npt.NDArray[np.float64]
    """(3, 3) intrinsics of the colour image, px."""
    world_from_camera: npt.NDArray[np.float64]
    """(4, 4) pose of the rectified left camera, metres."""
    baseline_m: float
    """Distance between the two cameras, metres."""
    doffs_px: float
    """cx of the right camera minus cx of the left one, px of the colour image."""
    exposure_tai_ns: int
    """Centre of the exposure on CLOCK_TAI, nanoseconds."""
    calibration: str
    """Identifies the calibration of the rig."""

    def __init__(self, memory: SharedMemory, head: dict[str, Any]) -> None:
        self.rig = head["rig"]
        self.K = np.array(head["K"], dtype=np.float64)
        self.world_from_camera = np.vstack([np.array(head["world_from_camera"]), [0, 0, 0, 1]])
        self.baseline_m = head["baseline_m"]
        self.doffs_px = head["doffs_px"]
        self.exposure_tai_ns = head["exposure_tai_ns"]
        self.calibration = head["calibration"]
        self.size = (head["width"], head["height"])
        self._memory = memory
        self._colour = head["colour"]
        self._disparity = head["disparity"]

    def _array(self, place: dict[str, int], dtype: Any, channels: int) -> npt.NDArray[Any]:
        height, width = place["height"], place["width"]
        flat = np.frombuffer(
            self._memory.buffer, dtype=dtype, count=height * width * channels, offset=place["offset"]
        )
        return flat.reshape((height, width, channels) if channels > 1 else (height, width))

    @cached_property
    def rgba(self) -> npt.NDArray[np.uint8]:
        """(height, width, 4) R, G, B and 255, corrected to the colours of the stage."""
        if self._colour is None:
            raise VantageError(f"the frame of rig {self.rig} has no colour")
        return self._array(self._colour, np.uint8, 4)

    @property
    def colour(self) -> npt.NDArray[np.uint8]:
        """(height, width, 3) R, G, B: a view of ``rgba``."""
        return self.rgba[..., :3]

    @property
    def has_disparity(self) -> bool:
        """Whether the frame has disparity; raw pairs have none."""
        return self._disparity is not None

    @cached_property
    def disparity_steps(self) -> npt.NDArray[np.uint16]:
        """(h, w) disparity in steps of 1/32 px of its own width, 0 where it is unknown."""
        if self._disparity is None:
            raise VantageError(f"the frame of rig {self.rig} has no disparity")
        return self._array(self._disparity, np.uint16, 1)

    @property
    def disparity_scale(self) -> float:
        """Width of the disparity map as a share of that of the colour image."""
        return self.disparity_steps.shape[1] / self.size[0]

    @cached_property
    def disparity(self) -> npt.NDArray[np.float32]:
        """(h, w) disparity in px of its own width, NaN where it is unknown."""
        steps = self.disparity_steps
        disparity = steps.astype(np.float32)
        disparity *= 1 / _STEPS_PER_PX
        disparity[steps == 0] = np.nan
        return disparity

    @cached_property
    def depth(self) -> npt.NDArray[np.float32]:
        """(h, w) depth along the camera's z axis in metres, NaN where it is unknown."""
        scale = self.disparity_scale
        shifted = self.disparity + np.float32(self.doffs_px * scale)
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = np.float32(self.K[0, 0] * scale * self.baseline_m) / shifted
        depth[~(shifted > 0)] = np.nan
        return depth

    @property
    def depth_K(self) -> npt.NDArray[np.float64]:
        """(3, 3) intrinsics of the depth and the disparity map, px."""
        height, width = self.disparity_steps.shape
        scale = np.array([width / self.size[0], height / self.size[1]])
        K = self.K.copy()
        K[:2, :2] *= scale[:, None]
        # Pixel centres are at integer coordinates.
        K[:2, 2] = (K[:2, 2] + 0.5) * scale - 0.5
        return K

    def points(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]:
        """(n, 3) positions in the world in metres, and (n, 3) R, G, B of all pixels with depth."""
        depth = self.depth
        rows, columns = np.nonzero(np.isfinite(depth))
        z = depth[rows, columns].astype(np.float64)
        rays = np.stack([columns, rows, np.ones_like(rows)]) * z
        at = self.world_from_camera[:3, :3] @ (np.linalg.inv(self.depth_K) @ rays)
        at += self.world_from_camera[:3, 3:]
        colour = self.colour
        colours = colour[
            rows * colour.shape[0] // depth.shape[0], columns * colour.shape[1] // depth.shape[1]
        ]
        return at.T.astype(np.float32), colours

    def __repr__(self) -> str:
        return f"<vantage.View of rig {self.rig}, {self.size[0]}x{self.size[1]}>"


class FrameSet(Sequence[View]):
    """The frames of all rigs that belong to one trigger pulse: a sequence of views, and a mapping
    by the names of the rigs."""

    pulse: int
    """Index of the trigger pulse: pulse k leaves at k / rate after 1970-01-01T00:00:00 TAI."""
    timecode: str
    """Time code of the pulse at the pulse rate."""
    damaged: list[str]
    """A sentence for each frame that is damaged and left out."""
    decoding_s: float
    """How long the frames took to read and decode, seconds."""

    def __init__(self, memory: SharedMemory, head: dict[str, Any]) -> None:
        self.pulse = head["pulse"]
        self.timecode = head["timecode"]
        self.damaged = head["damaged"]
        self.decoding_s = head["decoding_s"]
        self._views = [View(memory, view) for view in head["views"]]

    @property
    def rigs(self) -> list[str]:
        """Names of the rigs with a frame."""
        return [view.rig for view in self._views]

    def __len__(self) -> int:
        return len(self._views)

    def __getitem__(self, key: Any) -> Any:
        if not isinstance(key, str):
            return self._views[key]
        for view in self._views:
            if view.rig == key:
                return view
        raise KeyError(f"pulse {self.pulse} has no frame of rig '{key}', only of {self.rigs}")

    def points(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]:
        """(n, 3) positions in the world in metres, and (n, 3) R, G, B, of all rigs with depth."""
        clouds = [view.points() for view in self._views if view.has_disparity]
        if not clouds:
            return np.empty((0, 3), np.float32), np.empty((0, 3), np.uint8)
        return np.concatenate([at for at, _ in clouds]), np.concatenate([rgb for _, rgb in clouds])

    def __repr__(self) -> str:
        return f"<vantage.FrameSet of pulse {self.pulse}, {self.timecode}: {', '.join(self.rigs)}>"


@dataclass(frozen=True)
class CameraTicks:
    """The camera of every tick of the programme that was recorded with a take."""

    tick: npt.NDArray[np.int64]
    """(n,) number of the tick."""
    pulse: npt.NDArray[np.int64]
    """(n,) pulse that the tick showed."""
    time_s: npt.NDArray[np.float64]
    """(n,) time on CLOCK_TAI, seconds."""
    world_from_camera: npt.NDArray[np.float64]
    """(n, 4, 4) poses, metres."""
    field_of_view_rad: npt.NDArray[np.float64]
    """(n,) horizontal field of view, radians."""
    focus_m: npt.NDArray[np.float64]
    """(n,) distance of the focal plane, metres."""


class Take(Sequence[FrameSet]):
    """A take, as a sequence of its frame sets in the order of their pulses.

    The take is read by a process of its own, which ends with ``close()``, at the end of a ``with``
    block, or with this object. Arrays that were taken from it stay valid. Not thread-safe.
    """

    path: Path
    """The file."""
    rigs: list[str]
    """Names of all rigs."""
    pulses: npt.NDArray[np.int64]
    """(n,) pulses with a frame of any rig, ascending."""
    pulse_rate_hz: float
    """Pulses per second."""
    timecode: str
    """Time code of the start."""
    tai_offset_s: int
    """By how much the rigs' clock is ahead of UTC, seconds."""
    ticks: int
    """Number of recorded ticks of the programme's camera."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._released: list[int] = []
        self._process = subprocess.Popen(
            [find_program("vantage"), "take", "serve", os.fspath(path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        head = self._read()
        self.rigs = head["rigs"]
        self.pulses = np.array(head["pulses"], dtype=np.int64)
        self.pulse_rate_hz = head["pulse_rate_hz"]
        self.timecode = head["timecode"]
        self.tai_offset_s = head["tai_offset_s"]
        self.ticks = head["ticks"]

    def _read(self) -> dict[str, Any]:
        assert self._process.stdout is not None and self._process.stderr is not None
        line = self._process.stdout.readline()
        if not line:
            log = self._process.stderr.read()
            self.close()
            raise VantageError(last_sentence(log))
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise VantageError(answer["error"])
        return answer

    def _ask(self, request: dict[str, Any]) -> tuple[SharedMemory, dict[str, Any]]:
        if self._process.poll() is not None or self._process.stdin is None:
            raise VantageError(f"{self.path} is closed")
        # The garbage collector may add to the list at any time.
        request["released"] = [self._released.pop() for _ in range(len(self._released))]
        self._process.stdin.write(json.dumps(request) + "\n")
        self._process.stdin.flush()
        answer = self._read()
        memory = SharedMemory(f"/proc/{self._process.pid}/fd/{answer['fd']}", answer["bytes"])
        memory.at_end(_release, self._released, answer["memory"], _forks)
        return memory, answer

    def at(self, pulse: int) -> FrameSet:
        """The frame set of a pulse. Raises VantageError if no rig has a frame of it."""
        memory, answer = self._ask({"pulse": int(pulse)})
        return FrameSet(memory, answer)

    def cameras(self) -> CameraTicks:
        """The recorded flight of the programme's camera."""
        memory, answer = self._ask({"cameras": True})
        place = answer["cameras"]
        rows = np.frombuffer(
            memory.buffer, np.float64, place["height"] * place["width"], place["offset"]
        ).reshape(place["height"], place["width"])
        poses = np.tile(np.eye(4), (len(rows), 1, 1))
        poses[:, :3, :] = rows[:, 3:15].reshape(-1, 3, 4)
        return CameraTicks(
            rows[:, 0].astype(np.int64),
            rows[:, 1].astype(np.int64),
            rows[:, 2].copy(),
            poses,
            rows[:, 15].copy(),
            rows[:, 16].copy(),
        )

    def close(self) -> None:
        """Ends the process that reads the take."""
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            if pipe is not None and not pipe.closed:
                pipe.close()
        self._process.wait()

    def __enter__(self) -> Take:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def __del__(self) -> None:
        if hasattr(self, "_process"):
            self.close()

    def __len__(self) -> int:
        return len(self.pulses)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return [self.at(pulse) for pulse in self.pulses[index]]
        return self.at(self.pulses[index])

    def __iter__(self) -> Iterator[FrameSet]:
        for pulse in self.pulses:
            yield self.at(pulse)

    def __repr__(self) -> str:
        return f"<vantage.Take {self.path}: {len(self)} frame sets of {', '.join(self.rigs)}>"
