"""What a recordings table holds, and what looks wrong in it, before anything is fitted."""

from armscope.check.report import CheckReport, check

__all__ = ["CheckReport", "check"]
