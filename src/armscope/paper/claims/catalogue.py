"""Every claim that is judged: the paper's own with page and wording, what nested fits make true, and its outlook."""

from __future__ import annotations

from functools import partial

from armscope.errormodels.features import FDP_CI, SDP_AI, SDP_CI
from armscope.paper.claims import judges
from armscope.paper.claims.claim import FIRST_FOUR, OVER_TESTS, OWN, PRODUCT, REGIONS, TAUTOLOGY, WITHOUT, Claim
from armscope.paper.claims.judges import CLOSE_PER_CENT, FOURIER, FOURTH, PRINTED_ITERATIONS
from armscope.paper.outlook import PRODUCTS, SUB_VOLUMES
from armscope.paper.printed import TEST_TRAJECTORIES


def _on_trajectory(number: str, trajectory: str, source: str, wording: str) -> Claim:
    return Claim(
        f"cartesian_{trajectory[-1]}",
        f"Cartesian input beats angular input on trajectory {number}",
        OWN,
        source,
        wording,
        "3D error of FDP(CI) below FDP(AI), and of SDP(CI) below SDP(AI)",
        "ratio AI / CI of the 3D errors, the smaller of both degrees",
        "",
        partial(judges.cartesian_beats_angular, trajectory=trajectory),
        needs=("FDP(CI)", "FDP(AI)"),
    )


OWN_CLAIMS = (
    Claim(
        "smaller",
        "The functions predict the errors: what is left is smaller",
        OWN,
        "p. 956, abstract; p. 965, section 8",
        "the positioning errors of robot manipulators can be effectively predicted using some constant coefficient "
        "polynomials",
        "each model of the paper leaves a smaller 3D error on each of the three test trajectories",
        "smallest ratio uncompensated / residual of the 3D errors",
        "",
        judges.reduced,
        any_of=FIRST_FOUR,
    ),
    Claim(
        "as_printed",
        "The functions predict the errors as well as Table 2 prints",
        OWN,
        "p. 961, section 6.3 and Table 2",
        "describe the positioning errors quite well, as seen in Fig. 4 and in Table 2",
        "in at least half of the printed cells the error shrinks at least by the printed factor",
        "share of the printed cells that shrink at least by the printed factor",
        "%",
        judges.shrunk_as_printed,
        any_of=FIRST_FOUR,
    ),
    Claim(
        "similar_axes",
        "The models do as well in x and z as in y",
        OWN,
        "p. 961, Fig. 4",
        "the modeling performance in the x and z directions are quite similar",
        f"errors left on the identification poses differ between axes by at most a factor of {judges.SIMILAR:g}, in "
        "each model",
        "largest ratio of two axes over the models",
        "",
        judges.axes_similar,
        any_of=FIRST_FOUR,
    ),
    _on_trajectory(
        "I",
        TEST_TRAJECTORIES[0],
        "p. 962, section 7.1",
        "the Cartesian space polynomials perform better over the joint space polynomials in predicting the positioning "
        "errors",
    ),
    _on_trajectory(
        "II",
        TEST_TRAJECTORIES[1],
        "p. 964, section 7.2",
        "Similar to the finding of test trajectory I, the Cartesian space polynomials perform better",
    ),
    _on_trajectory("III", TEST_TRAJECTORIES[2], "p. 961, Table 2 (not said in the text)", ""),
    Claim(
        "alternative",
        "The swarm is an alternative to least squares",
        OWN,
        "p. 961, section 6.3",
        "the PSO method is an alternative to the classical least-square estimation algorithm",
        f"no fit of the paper's models ends more than {CLOSE_PER_CENT:g} % above least squares",
        "largest excess over the least-squares residual",
        "%",
        judges.equals_least_squares,
        any_of=FIRST_FOUR,
    ),
    Claim(
        "iterations",
        "200 iterations suffice",
        OWN,
        "p. 960, section 5",
        "particles are likely to converge quickly to the best solution",
        f"every fit of the paper's models is within {CLOSE_PER_CENT:g} % of least squares by iteration "
        f"{PRINTED_ITERATIONS}",
        "iterations until the slowest fit is there (∞: never)",
        "",
        judges.iterations_suffice,
        any_of=FIRST_FOUR,
    ),
    Claim(
        "efficient",
        "The swarm is a very efficient optimiser",
        OWN,
        "p. 965, section 8",
        "the PSO method is a very efficient optimizer that demonstrates fast convergence",
        "every fit of the paper's models ends nearer to least squares than random search with as many evaluations",
        "excess of the swarm over that of random search, the worst model",
        "",
        judges.beats_random_search,
        any_of=FIRST_FOUR,
    ),
    Claim(
        "cost",
        "Its computational cost is relatively small",
        OWN,
        "p. 965, section 8",
        "with a relatively small computational cost",
        f"it is within {CLOSE_PER_CENT:g} % of least squares for at most {judges.SMALL_COST:g} times the arithmetic of "
        "least squares",
        "evaluations, as multiples of the arithmetic of least squares (∞: never there)",
        "",
        judges.small_cost,
        any_of=FIRST_FOUR,
    ),
    Claim(
        "fourier",
        "Fourier polynomials are more accurate than ordinary ones",
        OWN,
        "p. 962, section 6.3",
        "the Fourier polynomials estimate the positioning errors more accurately than the ordinary polynomials",
        "over I–III together, Fourier with 2 harmonics comes closer than the 4th degree (as many coefficients)",
        f"ratio ordinary / Fourier, {OVER_TESTS}",
        "",
        judges.fourier_beats_ordinary,
        needs=(FOURTH, FOURIER),
    ),
    Claim(
        "same_outcome",
        "That outcome will not change with the algorithm",
        OWN,
        "p. 962, section 6.3",
        "This outcome will not change with the algorithm employed to estimate the polynomial coefficients",
        "the same of both is closer over I–III by this method as by least squares",
        "ratio ordinary / Fourier by this method, over that by least squares",
        "",
        judges.same_outcome,
        needs=(FOURTH, FOURIER),
    ),
    Claim(
        "remedied",
        "Fourth-order and Fourier models remedy the angular models",
        OWN,
        "p. 962, section 7.1",
        "Fourier polynomials with double harmonics and fourth order polynomials, which contain 75 coefficients, have "
        "remedied this problem successfully",
        "over I–III together, one of them comes at least as close as FDP(CI)",
        f"ratio FDP(CI) / the better of the two, {OVER_TESTS}",
        "",
        judges.remedied,
        needs=("FDP(CI)", FOURTH, FOURIER),
    ),
    Claim(
        "improved",
        "They improve on the angular first degree significantly",
        OWN,
        "p. 964, section 7.2",
        "the error estimation based on the data provided in the joint space can be improved significantly",
        "over I–III together, both come closer than FDP(AI)",
        f"ratio FDP(AI) / the worse of the two, {OVER_TESTS}",
        "",
        judges.improved,
        needs=("FDP(AI)", FOURTH, FOURIER),
    ),
    Claim(
        "minimum_data",
        "85 poses are the minimum of experimental data",
        OWN,
        "p. 957, section 1; p. 965, section 8",
        "the self-calibration of robot manipulators with minimum experimental data",
        "no smaller number of well-spread poses brings FDP(CI) within 10 % of what 340 poses give on I–III",
        "poses that suffice",
        "",
        judges.poses_not_wasted,
        fitted=WITHOUT,
    ),
)
"""In the order of the table."""


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
CLAIMS = (*OWN_CLAIMS, *OTHER_CLAIMS)
