"""From recordings to a verdict: atlas, selection, refit, certainty, leftover, validation."""

from armscope.diagnosis.output import write_verdict
from armscope.diagnosis.pipeline import Settings, diagnose
from armscope.diagnosis.transfer import Transferred, transfer
from armscope.diagnosis.verdict import Verdict

__all__ = ["Settings", "Transferred", "Verdict", "diagnose", "transfer", "write_verdict"]
