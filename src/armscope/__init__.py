"""armscope: see where a robot arm misses its target, and why.

In a notebook or a script, with the same order of arguments as on the command line:

    import armscope

    found = armscope.diagnose("recordings.csv", "robot.yaml")
    found                       # one paragraph; a table of causes in a notebook
    found.plot()                # the arm with the guilty places
    found.report("out")         # what `armscope diagnose -o out` writes

Nothing is imported before it is used.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from armscope.core.inputs import InputError
    from armscope.notebook.commands import (
        calibrate,
        check,
        choose_poses,
        compare,
        compensate,
        diagnose,
        predict,
        read_recordings,
        read_robot,
    )
    from armscope.notebook.notes import PosesWarning, PredictionWarning
    from armscope.verdict.files import read_verdict

__all__ = [
    "InputError",
    "PosesWarning",
    "PredictionWarning",
    "calibrate",
    "check",
    "choose_poses",
    "compare",
    "compensate",
    "diagnose",
    "predict",
    "read_recordings",
    "read_robot",
    "read_verdict",
]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    elsewhere = {
        "InputError": "core.inputs",
        "PosesWarning": "notebook.notes",
        "PredictionWarning": "notebook.notes",
        "read_verdict": "verdict.files",
    }
    home = elsewhere.get(name, "notebook.commands")
    return getattr(importlib.import_module(f"{__name__}.{home}"), name)


def __dir__() -> list[str]:
    return sorted([*(name for name in globals() if name.startswith("__")), *__all__])


class _Package(ModuleType):
    """The room `armscope.check` and the function have one name: to a user it is the function's, whoever came first."""

    def __setattr__(self, name: str, value: object) -> None:
        if not (name in __all__ and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
