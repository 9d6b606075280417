"""Compiled templates kept beside them, as Python keeps its own bytecode: compiling them takes as long as drawing."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from pickle import UnpicklingError
from typing import TYPE_CHECKING

from jinja2 import BytecodeCache

if TYPE_CHECKING:
    from jinja2.bccache import Bucket


class BesideTemplates(BytecodeCache):
    """In ``__pycache__`` beside the templates, or where PYTHONPYCACHEPREFIX says; nowhere where that can't be written.

    Jinja compares a digest of the template, and its own and Python's version, before it takes what is kept.

    Args:
        folder: of the templates.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def _file(self, bucket: Bucket) -> Path:
        return Path(importlib.util.cache_from_source(str(self.folder / f"{bucket.key}.jinja.py")))

    def load_bytecode(self, bucket: Bucket) -> None:
        """Take what is kept; whatever can't be read is compiled anew."""
        with (
            contextlib.suppress(OSError, ValueError, EOFError, TypeError, UnpicklingError),
            self._file(bucket).open("rb") as kept,
        ):
            bucket.load_bytecode(kept)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep what was compiled, whole or not at all."""
        if sys.dont_write_bytecode:
            return
        path = self._file(bucket)
        with contextlib.suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=path.parent)
            try:
                with os.fdopen(handle, "wb") as made:
                    bucket.write_bytecode(made)
                Path(name).replace(path)
            except BaseException:
                Path(name).unlink(missing_ok=True)
                raise
