"""Starts the programs of Vantage."""

from __future__ import annotations

import os
import shutil
import subprocess
from typing import Sequence


class VantageError(RuntimeError):
    """A file, an argument or a device cannot be used. The message is one sentence."""


def find_program(name: str) -> str:
    """Path of a program: in the folder of the environment variable VANTAGE_PROGRAMS, or in PATH."""
    folder = os.environ.get("VANTAGE_PROGRAMS")
    path = shutil.which(name, path=folder)
    if path is None:
        raise VantageError(
            f"the program {name} is not in {folder or 'PATH'}: install the package {name}, "
            "or set VANTAGE_PROGRAMS to its folder"
        )
    return path


def last_sentence(log: str) -> str:
    """The last line of a program's log, without the words before its sentence."""
    lines = [line.strip() for line in log.splitlines() if line.strip()]
    if not lines:
        return "the program ended without a reason"
    return lines[-1].split("error: ", 1)[-1]


def run(name: str, arguments: Sequence[str]) -> str:
    """Runs a program to its end and returns its standard output."""
    done = subprocess.run(
        [find_program(name), *arguments], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise VantageError(last_sentence(done.stderr))
    return done.stdout
