"""Everything that is judged, in the order of the table."""

from __future__ import annotations

from armscope.paper.claims.others import OTHER_CLAIMS
from armscope.paper.claims.own import OWN_CLAIMS

CLAIMS = (*OWN_CLAIMS, *OTHER_CLAIMS)
