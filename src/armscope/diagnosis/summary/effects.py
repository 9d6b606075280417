"""One named effect with everything that is known about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.diagnosis.constants import NAMING
from armscope.diagnosis.naming import nested_log_odds
from armscope.diagnosis.scans.change_points import when_stderr
from armscope.diagnosis.scans.context import ScanContext
from armscope.diagnosis.state import DiagnosisState
from armscope.diagnosis.summary.alternatives import listed, specific_name
from armscope.diagnosis.summary.balancing_spring import balancing_spring
from armscope.diagnosis.summary.effect_curve import curve_of
from armscope.diagnosis.summary.homogeneity import SameSize
from armscope.diagnosis.summary.leaning_gravity import LEVEL_IT, LOOK_AT_THE_LEVEL
from armscope.diagnosis.summary.parameters import parameters, undetermined
from armscope.diagnosis.summary.rivals import Rival, discriminability, too_close
from armscope.diagnosis.summary.soft_drives import CURE_OF_DRIVES, LOOK_AT_DRIVES
from armscope.fitting.discrepancy import ModelError
from armscope.fitting.refit import Refit
from armscope.inference.model_space import Candidate
from armscope.inference.normal_equations import NormalEquations, projected_rms
from armscope.inference.problem import SelectedEffect
from armscope.inference.search import Search
from armscope.physics.backgrounds import FAMILIES, TRANSMISSION
from armscope.physics.effect import Part, Placed
from armscope.physics.elastic import JOINT_COMPLIANCE, UNKNOWN_MASSES
from armscope.physics.scene import Scene
from armscope.verdict.effects import Alternative, FoundEffect, Parameter
from armscope.verdict.schema import Background
from armscope.verdict.wording import effect_in_words

FIRST_LOOKS = {
    "leaning_gravity": (LOOK_AT_THE_LEVEL, LEVEL_IT),
    JOINT_COMPLIANCE.name: (LOOK_AT_DRIVES, CURE_OF_DRIVES),
}
"""What to look at before an effect is believed, and what stands before its cure, by what else it may be."""


@dataclass(frozen=True, eq=False)
class SummaryBasis:
    """What the summaries of all effects rest on."""

    state: DiagnosisState  # the finished selection
    search: Search  # its search
    rivals: Mapping[int, Sequence[Rival]]  # what could stand in the place of each candidate
    inclusion: Mapping[int, float]  # inclusion frequency by candidate
    scene: Scene  # recorded rows, spread evenly where there are many
    equations: NormalEquations  # sums over all rows as they were measured
    model_error: ModelError  # what no effect explains, and what it does to the covariance
    # by candidate, what backgrounds of other sizes and other laws of its joint add to the covariance
    other_doubt: Mapping[int, Array]
    # by candidate, what does as well and is to be looked at first: gravity that leans, soft drives
    instead: Mapping[int, Alternative]


def summarise_effect(basis: SummaryBasis, chosen: SelectedEffect, part: Part, share: float) -> FoundEffect:
    """One effect with everything that is known about it.

    Args:
        basis: what is known of all of them.
        chosen: the effect, with its size.
        part: its place in the fitted model.
        share: of the mean square that it explains, 0 ... 1.

    Returns:
        The effect as the verdict has it.
    """
    state, search, rivals = basis.state, basis.search, basis.rivals[chosen.candidate]
    fit, placed, candidate = state.fit, part.placed, search.candidate(chosen.candidate)
    words = placed.effect.told_as(float(part.values[0]))
    at = fit.layout.of(placed)
    coefficients = np.zeros(len(fit.layout.terms))
    coefficients[at] = _sized(state, chosen, part, fit.covariance_of(placed))
    values, covariance = _with_drive_of_background(fit, part, basis.model_error.covariance)
    covariance = covariance + _other_doubt(basis, chosen, part)
    rms = projected_rms(basis.equations, fit.layout.frames, coefficients)
    if candidate.is_curve:
        rms = min(rms, _own_size(fit, part))
    apart = [discriminability(state.best, r.hypothesis, candidate, r.candidate) for r in rivals]
    named_as, title = specific_name(candidate, too_close(candidate, rivals, apart))
    others, confirm, cure = listed(rivals, apart), words.confirm, words.cure.words
    spring = balancing_spring(fit.model, part, basis.scene)
    if spring is not None:
        rival, look = spring
        others, confirm = (rival, *others), f"{look} {confirm}"
        if named_as == "effect" and placed.name != JOINT_COMPLIANCE.name:  # the drive gives way beside a spring as well
            named_as, title = "region", f"{title} or {effect_in_words(rival.effect, rival.location)}"
    instead = basis.instead.get(chosen.candidate)
    if instead is not None:
        look, first = FIRST_LOOKS[instead.effect]
        others, confirm, cure = (instead, *others), f"{look} {confirm}", f"{first} {cure}"
        named_as, title = "region", f"{title} or {effect_in_words(instead.effect, instead.location)}"
    left_open = undetermined(placed, covariance)
    told = tuple(p for p in parameters(placed, values, covariance) if p.name not in left_open)
    found = FoundEffect(
        effect=placed.name,
        location=placed.location,
        family=placed.family,
        driver=placed.driver,
        named_as=named_as,
        title=title,
        minor=False,
        parameters=_with_moment(state, search, chosen, placed, told),
        undetermined=left_open,
        rms_at_tool_mm=rms,
        share=share,
        evidence_nats=float(_worth(state, search, chosen)),
        alternatives=others,
        inclusion=basis.inclusion.get(chosen.candidate),
        curve=curve_of(placed, part.values, covariance, basis.scene),
        physics=words.physics,
        confirm=confirm,
        cure=cure,
    )
    return _as_sure_as_its_size(found, candidate)


def _as_sure_as_its_size(found: FoundEffect, candidate: Candidate) -> FoundEffect:
    """An effect; one whose sizes may all be zero, or that no table drawn anew has, is told by its kind and region only.

    Two that stand in for each other are both worth their evidence, and neither may be there: a tool that bent under its
    payload was a bearing to be replaced and a centre of mass by -24 +- 88 mm.
    """
    if found.named_as != "effect" or not (found.size_open or found.never_chosen):
        return found
    named_as, title = specific_name(candidate, [candidate])
    return replace(found, named_as=named_as, title=title)


def _with_drive_of_background(fit: Refit, part: Part, covariance: Array) -> tuple[Array, Array]:
    """An effect's values and their covariance; of a drive under unknown masses with what a background has of it.

    The background's drive gives way to the load of the stated masses and the payload, the effect to other masses and
    the payload: under the payload, by which it is told, they give way together.
    """
    placed, at = part.placed, fit.layout.of(part.placed)
    own = covariance[np.ix_(at, at)]
    (number,) = [n for n, term in enumerate(placed.terms) if term.name == "compliance"] or [-1]
    drives = (p for p in fit.model.background if p.placed.key == placed.key and p.placed.variant == "")
    if placed.variant != UNKNOWN_MASSES or number < 0 or (drive := next(drives, None)) is None:
        return part.values, own
    (beside,) = fit.layout.of(drive.placed)
    together = np.eye(len(at), len(at) + 1)
    together[number, -1] = 1.0
    every = np.append(at, beside)
    values = together @ np.append(part.values, drive.values)
    return values, together @ covariance[np.ix_(every, every)] @ together.T


def _sized(state: DiagnosisState, chosen: SelectedEffect, part: Part, covariance: Array) -> Array:
    """An effect's values for its size at the tool: what its rows leave open counts as its prior has it.

    The refit holds named values by a prior so wide that it does not pull; two of them that only show together (offsets
    along parallel axes) are then told with their wide intervals, but could stand for any size at the tool.
    """
    problem, candidate = state.problem, state.space.candidates[chosen.candidate]
    if candidate.is_curve:
        return part.values  # its prior is that already
    scale = (problem.prior_scale(chosen) / problem.scale[candidate.columns])[_fitted_terms(state, chosen, part)]
    # the posterior with this prior in place of a flat one
    scaled = covariance / np.outer(scale, scale)
    return np.asarray(scale * (np.linalg.solve(np.eye(len(scale)) + scaled, part.values / scale)))


def _other_doubt(basis: SummaryBasis, chosen: SelectedEffect, part: Part) -> Array:
    """(k, k) what `other_doubt` adds to the covariance of a part's values; zeros where it says nothing of them."""
    doubt = basis.other_doubt.get(chosen.candidate)
    if doubt is None:
        return np.zeros((len(part.values),) * 2)
    its = _fitted_terms(basis.state, chosen, part)
    return np.asarray(doubt[np.ix_(its, its)])


def _fitted_terms(state: DiagnosisState, chosen: SelectedEffect, part: Part) -> list[int]:
    """Which of its candidate's terms a part was fitted with: a length that another row holds is not among them."""
    terms = state.space.placed[chosen.candidate].terms
    return [terms.index(term) for term in part.placed.terms]


def _own_size(fit: Refit, curve: Part) -> float:
    """RMS per axis, mm, of what a curve does that neither frames nor other effects nor backgrounds could do for it.

    Low waves of a free curve look like zeros, lengths and loads of the arm: without this, an arm's small errors would
    make any curve in it large. Waves that all gears have a little of count with their joint's curve.
    """
    values = {
        t: float(v) for p in (*fit.model.background, curve) for t, v in zip(p.placed.terms, p.values, strict=True)
    }
    own = {fit.layout.index[term] for term in curve.placed.terms}
    moved = {product.direction for term in curve.placed.terms for product in term.products}
    waves = fit.layout.background[FAMILIES.index(TRANSMISSION)]
    own |= {int(n) for n in waves if fit.layout.terms[n].products[0].direction in moved}
    at = np.array(sorted(own))
    told = np.array([values.get(fit.layout.terms[n], 0.0) for n in at])
    left = np.linalg.inv(fit.covariance[np.ix_(at, at)]) - np.diag(fit.precision[at])
    return float(fit.noise * np.sqrt(max(float(told @ left @ told), 0.0) / max(fit.equations.n, 1.0)))


def _with_moment(
    state: DiagnosisState, search: Search, chosen: SelectedEffect, placed: Placed, told: tuple[Parameter, ...]
) -> tuple[Parameter, ...]:
    """Parameters with the standard error of a jump's moment."""
    if placed.family != "drift" or not placed.scanned:
        return told
    without = search.without(state.best, [chosen.candidate])
    context = ScanContext(state.problem, state.space, state.point, state.recordings, state.fit.weights)
    stderr = when_stderr(placed, context, without)
    return (*told[:-1], replace(told[-1], stderr=stderr))


def _worth(state: DiagnosisState, search: Search, chosen: SelectedEffect) -> float:
    """Evidence for a name, nats."""
    if chosen.nested:
        return nested_log_odds(state.problem, state.best, chosen)
    return search.log_odds(state.best, chosen.candidate)


def as_far_as_it_carries(found: FoundEffect, candidate: Candidate, over: SameSize | None) -> FoundEffect:
    """An effect with what other rows say of its size: one of different sizes is told by its kind and region only.

    Args:
        found: the effect.
        candidate: of which it is.
        over: whether runs, payloads and halves of the workspace agree; None where that could not be asked.

    Returns:
        The effect, less specific where they do not agree.
    """
    if over is None:
        return found
    if not over.agrees and found.named_as == "effect":
        named_as, title = specific_name(candidate, [candidate])
        found = replace(found, named_as=named_as, title=title)
    return replace(found, carries_over=over.text)


def with_weight(found: FoundEffect, background: Sequence[Background]) -> FoundEffect:
    """Minor or not: in an arm with small errors everywhere, a small effect is one of them.

    An effect is asked twice: by the share that a fit gives it, and by the share that its cure has. What is not geometry
    may be major all the same by what a calibration leaves (`armscope.verdict.importance`).
    """
    ordinary = any(family.present for family in background)
    return replace(found, minor=found.share < (NAMING.minor_share if ordinary else NAMING.minor_share_of_perfect_arm))
