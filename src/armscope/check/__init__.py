"""What a recordings table holds, and what looks wrong in it, before anything is fitted."""

from armscope.check.report import CheckReport, check
from armscope.check.suspicion import Suspicion
from armscope.check.suspicions import against_arm

__all__ = ["CheckReport", "Suspicion", "against_arm", "check"]
