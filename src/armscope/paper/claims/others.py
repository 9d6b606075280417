"""What is true of every nested fit, and what the paper leaves for later."""

from __future__ import annotations

from functools import partial

from armscope.errormodels.features import FDP_CI, SDP_AI, SDP_CI
from armscope.paper.claims import judges
from armscope.paper.claims.claim import OVER_TESTS, PRODUCT, REGIONS, TAUTOLOGY, WITHOUT, Claim
from armscope.paper.claims.judges import FOURIER, FOURTH
from armscope.paper.outlook import PRODUCTS, SUB_VOLUMES


def _regions(key: str, claim: str, criterion: str, held_out: bool, regions: int) -> Claim:
    return Claim(
        key,
        claim,
        REGIONS if held_out else TAUTOLOGY,
        "p. 961, section 6.3; p. 965, section 8",
        "the greater number of models is established […], the higher is the success",
        criterion,
        "ratio one region / several, " + (OVER_TESTS if held_out else "3D errors on the identification poses"),
        "",
        partial(judges.sub_volumes_help, regions=regions, held_out=held_out),
        fitted=WITHOUT,
    )


def _extended(kind: str, model: str, words: str) -> Claim:
    return Claim(
        f"{'regions' if kind == SUB_VOLUMES else 'products'}_{model}",
        words,
        REGIONS if kind == SUB_VOLUMES else PRODUCT,
        "p. 961, section 6.3; p. 965, section 8" if kind == SUB_VOLUMES else "p. 962, section 6.3",
        "can further be improved by dividing the manipulator workspace into subvolumes"
        if kind == SUB_VOLUMES
        else "the multiplication of the same polynomials can be used […] will be investigated and reported later",
        f"3D error of {model} so extended below that without, over I–III together",
        f"ratio plain / extended, {OVER_TESTS}",
        "",
        partial(judges.extension_helps, model=model, kind=kind),
        fitted=WITHOUT,
    )


OTHER_CLAIMS = (
    Claim(
        "second_degree",
        "Second-degree polynomials fit their own poses at least as well as first-degree ones",
        TAUTOLOGY,
        "p. 961, Table 2",
        "",
        "SDP ≤ FDP in x, y and z on the identification poses, for both inputs",
        "largest ratio SDP / FDP",
        "",
        judges.second_degree,
        needs=("FDP(CI)", "SDP(CI)"),
    ),
    _regions(
        "own_rows",
        "Four regions fit their own poses at least as well as one",
        "3D error of FDP(CI) with 4 regions below that with one on the identification poses",
        False,
        4,
    ),
    _regions(
        "two_regions", "Two regions", "3D error of FDP(CI) with 2 regions below one, over I–III together", True, 2
    ),
    _regions(
        "four_regions", "Four regions", "3D error of FDP(CI) with 4 regions below one, over I–III together", True, 4
    ),
    Claim(
        "called_for",
        "Cross-validation divides the workspace",
        REGIONS,
        "p. 961, section 6.3; p. 965, section 8",
        "",
        "cross-validation on the identification poses takes more than one blended region for FDP(CI)",
        "regions chosen (the fewest within one standard error of the best)",
        "",
        judges.chosen_by_cross_validation,
        fitted=WITHOUT,
    ),
    _extended(SUB_VOLUMES, FDP_CI.name, "As many as cross-validation chooses, first degree, Cartesian input"),
    _extended(SUB_VOLUMES, SDP_AI.name, "As many as cross-validation chooses, second degree, angular input"),
    _extended(PRODUCTS, SDP_CI.name, "Second degree, Cartesian input"),
    _extended(PRODUCTS, FOURTH, "Fourth degree, angular input"),
    _extended(PRODUCTS, FOURIER, "Two harmonics, angular input"),
)
"""In the order of the table."""
