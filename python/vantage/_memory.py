"""Shared memory of another program."""

from __future__ import annotations

import ctypes
import mmap
import os
import weakref
from typing import Any

_libc = ctypes.CDLL(None, use_errno=True)
_libc.mmap.restype = ctypes.c_void_p
_libc.mmap.argtypes = (
    ctypes.c_void_p,
    ctypes.c_size_t,
    ctypes.c_int,
    ctypes.c_int,
    ctypes.c_int,
    ctypes.c_long,
)
_libc.munmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t)
_FAILED = ctypes.c_void_p(-1).value


class SharedMemory:
    """A read-only mapping of a file. It ends when neither this object nor an array over it is held.

    Unlike ``mmap.mmap`` it keeps no file descriptor, of which a process has about a thousand.
    """

    def __init__(self, path: str, size: int) -> None:
        descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
        try:
            address = _libc.mmap(None, size, mmap.PROT_READ, mmap.MAP_SHARED, descriptor, 0)
            reason = ctypes.get_errno()
        finally:
            os.close(descriptor)
        if address == _FAILED:
            raise OSError(reason, os.strerror(reason), path)
        self._bytes = (ctypes.c_ubyte * size).from_address(address)
        self.at_end(_libc.munmap, address, size)
        self.buffer = memoryview(self._bytes).toreadonly()

    def at_end(self, function: Any, *arguments: Any) -> None:
        """Calls a function when the mapping is no longer held."""
        # At the end of the process other objects may still use it.
        weakref.finalize(self._bytes, function, *arguments).atexit = False
