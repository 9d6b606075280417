"""From recordings to a verdict: atlas, selection, refit, certainty, leftover, validation."""

from armscope.diagnosis.output import write_verdict
from armscope.diagnosis.pipeline import Settings, diagnose
from armscope.diagnosis.verdict import Verdict

__all__ = ["Settings", "Verdict", "diagnose", "write_verdict"]
