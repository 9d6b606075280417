"""What a recordings table holds, and what looks wrong in it, before anything is fitted.

What compares a table with an arm is imported when it is asked for: a table of motions needs none of it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.check.report import CheckReport, check
    from armscope.check.suspicion import Suspicion
    from armscope.check.suspicions import against_arm

__all__ = ["CheckReport", "Suspicion", "against_arm", "check"]
_HOMES = {"CheckReport": "report", "check": "report", "Suspicion": "suspicion", "against_arm": "suspicions"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
