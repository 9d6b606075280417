"""What a notebook or a script calls: each command as a function, in the same order of arguments."""

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
from armscope.notebook.motion import MotionDiagnosed
from armscope.notebook.result import Diagnosed
from armscope.verdict.files import read_verdict

__all__ = [
    "Diagnosed",
    "MotionDiagnosed",
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
