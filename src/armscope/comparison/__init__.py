"""What changed between recordings of one arm, or which of several arms is unlike the others."""

from armscope.comparison.changes import compare
from armscope.comparison.result import Change, Comparison, Left, Seen
from armscope.comparison.valued import Valued

__all__ = ["Change", "Comparison", "Left", "Seen", "Valued", "compare"]
