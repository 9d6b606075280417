"""From recordings to a verdict: rounds of selection and exact refit, then certainty, held-out rows and the atlas."""

from armscope.diagnosis.pipeline import Settings, diagnose
from armscope.fitting.transfer import Transferred, transfer
from armscope.verdict.diagnosis import Diagnosis
from armscope.verdict.files import write_verdict
from armscope.verdict.schema import Verdict

__all__ = ["Diagnosis", "Settings", "Transferred", "Verdict", "diagnose", "transfer", "write_verdict"]
