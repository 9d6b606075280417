"""The paper's claims, judged on robots drawn under its printed equations, by the method as printed and improved."""

from armscope.paper.claims.evidence import AS_PRINTED, IMPROVED, LEAST_SQUARES, Evidence
from armscope.paper.claims.table import SKIPPED, judge_claims, summarise

__all__ = ["AS_PRINTED", "IMPROVED", "LEAST_SQUARES", "SKIPPED", "Evidence", "judge_claims", "summarise"]
