"""Gather what the claims of a study are judged on."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from armscope.core.types import unheard
from armscope.errormodels.fitted import SwarmFit
from armscope.errormodels.swarm_fit import fit_random_search
from armscope.paper.claims import AS_PRINTED, IMPROVED, Evidence
from armscope.paper.measurements import Measurements
from armscope.paper.printed import PRINTED_MODELS
from armscope.swarm.settings import SwarmSettings


def gather(
    measurements: Measurements,
    improved: Sequence[SwarmFit],
    as_printed: Sequence[SwarmFit],
    tables: Mapping[str, pd.DataFrame],
    progress: Callable[[str], None] = unheard,
) -> dict[str, Evidence]:
    """Evidence by method, with random search beside each in the same coordinates and with as many evaluations.

    Args:
        measurements: of all robots.
        improved: fits by the configured method.
        as_printed: fits by the method as printed.
        tables: "sub_volumes", "outlook", "poses"; see `Evidence`.
        progress: told what is done.

    Returns:
        The evidence by the method's name.
    """
    found = {}
    for method, fits in ((AS_PRINTED, as_printed), (IMPROVED, improved)):
        progress(f"random search beside the method {method}")
        found[method] = Evidence.of(measurements, fits, random_search_beside(measurements, fits))
    of_the_method: dict[str, Any] = dict(tables)
    found[IMPROVED] = replace(found[IMPROVED], **of_the_method)
    return found


def random_search_beside(measurements: Measurements, fits: Sequence[SwarmFit]) -> list[SwarmFit]:
    """Random search for the paper's models in the coordinates of ``fits``, one seed."""
    mine = [fit for fit in fits if fit.name in PRINTED_MODELS]
    if not mine:
        return []
    specs = tuple({fit.name: fit.features.spec for fit in mine}.values())
    robots = list(dict.fromkeys(fit.label for fit in mine))
    first = mine[0]
    settings = SwarmSettings(particles=first.particles, iterations=first.history_mm.shape[2] - 1)
    problems = measurements.fit_problems(specs, robots)
    return fit_random_search(problems, first.seeds[:1], settings, first.basis, first.layout)
