"""One writer at a time: a lock file that names its owner, and that a dead owner does not hold."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import json
import os
import socket
import time
from datetime import datetime
from pathlib import Path
from typing import Any

TRIES, PAUSE_S = 5, 0.05  # A run that tidies up holds the locks of dead ones for a moment
_NO_FLOCK = (errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL)


class Busy(RuntimeError):
    """Another process writes there; the message says which, where and since when."""


class Lock:
    """An exclusive lock on a file, held by the operating system's ``flock``: it goes when its owner dies.

    Where a file system has no ``flock``, the process number in the file decides, on the host that it names.

    Args:
        path: the lock file; made when the lock is taken, removed when it is given back.
        what: what is locked, and by which command, for the message of others.
    """

    def __init__(self, path: Path, what: str) -> None:
        self.path, self.what = path, what
        self._handle: int | None = None

    def take(self) -> None:
        """Take the lock. Raises Busy: a living process holds it; OSError: the file can't be made."""
        tries = 0
        while self._handle is None:
            handle = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
            tries += 1
            try:
                if not _locked(handle):
                    if tries < TRIES:
                        time.sleep(PAUSE_S)
                        continue
                    raise Busy(f"{self.what}: {_in_words(_owner(handle))}. Wait for it, or choose another output.")
                if _is_still(handle, self.path):  # and not a file that the last owner has just removed
                    self._handle = handle
            finally:
                if self._handle is None:
                    os.close(handle)
        owner = {
            "pid": os.getpid(),
            "host": socket.gethostname(),
            "since": datetime.now().astimezone().isoformat(timespec="seconds"),
        }
        os.ftruncate(self._handle, 0)
        os.pwrite(self._handle, json.dumps(owner).encode(), 0)

    def free(self) -> bool:
        """Take the lock if nobody holds it."""
        try:
            self.take()
        except (Busy, OSError):
            return False
        return True

    def give_back(self) -> None:
        """Give the lock back, if it was taken."""
        if self._handle is not None:
            with contextlib.suppress(OSError):
                self.path.unlink()
            os.close(self._handle)
            self._handle = None


def alive(pid: int) -> bool:
    """Whether a process of this host lives."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True


def _locked(handle: int) -> bool:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno not in _NO_FLOCK:
            return False
        owner = _owner(handle)
        return not owner or (owner.get("host") == socket.gethostname() and not alive(int(owner.get("pid", 0))))
    return True


def _is_still(handle: int, path: Path) -> bool:
    with contextlib.suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(handle), path.stat())
    return False


def _owner(handle: int) -> dict[str, Any]:
    with contextlib.suppress(ValueError, OSError):
        content = json.loads(os.pread(handle, 4096, 0))
        if isinstance(content, dict):
            return content
    return {}


def _in_words(owner: dict[str, Any]) -> str:
    if not owner:
        return "another armscope is writing there"
    return f"process {owner.get('pid')} on {owner.get('host')} has been writing there since {owner.get('since')}"
