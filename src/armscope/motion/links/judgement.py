"""What is told of links beside their motors: causes with their numbers, and what they add to the verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.core.types import Array
from armscope.inference.evidence import evaluate
from armscope.inference.normal_equations import total
from armscope.inference.search import Search
from armscope.inference.shapley import shares
from armscope.motion.constants import TELLING
from armscope.motion.fitting.consistency import PathAgreement, agreement_of
from armscope.motion.fitting.selected import SelectedCauses
from armscope.motion.fitting.selection import model_of
from armscope.motion.library.causes import PlacedCause, Seen
from armscope.motion.library.twist_catalogue import ELASTICITY, NAMELESS
from armscope.motion.links.twist import SelectedTwist, select_twists, twist_rows
from armscope.motion.model.fitted_cause import FittedCause
from armscope.motion.samples.preparation import Preparation
from armscope.motion.samples.timing import Stretch
from armscope.motion.summary.doubts import swing_of, too_loose
from armscope.motion.summary.intervals import disagreeing, level_of_gains
from armscope.motion.summary.judgement import title
from armscope.motion.summary.rivals import listed_rivals
from armscope.motion.summary.words import clause, cure
from armscope.motion.verdict import FoundCause, LinkSide, MotionVerdict
from armscope.verdict.effects import Parameter
from armscope.verdict.schema import Answer
from armscope.verdict.wording import capitalised, percent


@dataclass(frozen=True, eq=False)
class JudgedTwist:
    """A joint's selection, how unsure the scale of its torque is (a share), and what is told of it."""

    selected: SelectedTwist
    unsure: float
    side: LinkSide

    @property
    def fitted(self) -> tuple[FittedCause, ...]:
        """Its zero and its causes with their numbers, as model.yaml holds them."""
        rows, best = self.selected.rows, self.selected.best
        values = self.selected.coefficients
        numbers = (0, *(effect.candidate + 1 for effect in best.chosen))
        return tuple(
            FittedCause(rows.placed[n], values[rows.at[n]], _covariance(self.selected, n, self.unsure)) for n in numbers
        )


def judged_twists(
    selected: SelectedCauses, seen: Seen, stretches: Sequence[Stretch], how: Preparation
) -> tuple[JudgedTwist, ...]:
    """Every joint whose link is recorded beside its motor.

    Args:
        selected: what the torques ask for: the masses, and with them the torque through each joint.
        seen: what the table shows.
        stretches: even samples.
        how: filters and decimation.

    Returns:
        Joint by joint; none of a table without such links.
    """
    model = model_of(selected)
    runs = tuple(dict.fromkeys(stretch.run for stretch in stretches))
    found = []
    for rows in twist_rows(seen, stretches, how, model):
        twist, unsure = select_twists(rows, runs), _unsure(selected, rows.joint, rows.torque)
        found.append(JudgedTwist(twist, unsure, _told(selected, twist, unsure, len(runs) > 1)))
    return tuple(found)


def _unsure(selected: SelectedCauses, j: int, torque: Array) -> float:
    """Share by which the scale of a joint's torque may be off: what is left of it in the torques, and the gains."""
    moving = ~selected.rows.still[:, j]
    own = torque - torque.mean()
    power = float(own[moving] @ own[moving])
    if power <= 0:
        return level_of_gains(selected.rows.layout)
    off = float(own[moving] @ selected.residuals[moving, j]) / power
    error = selected.weights.sigma[j] * np.sqrt(selected.weights.correlated[j] / power)
    return float(np.sqrt(off**2 + error**2 + level_of_gains(selected.rows.layout) ** 2))


def _covariance(twist: SelectedTwist, number: int, unsure: float) -> Array:
    """(c, c) of the numbers of a placed cause, SI: by how paths disagree and, of what is per torque, that scale."""
    best, scale, columns = twist.best, twist.problem.scale, twist.rows.at[number]
    wider = np.sqrt(disagreeing(best, scale, twist.blocks))[best.at(columns)]
    covariance = np.asarray(best.covariance(columns) * np.outer(wider / scale[columns], wider / scale[columns]))
    if twist.rows.placed[number].cause is ELASTICITY:
        covariance += (unsure * twist.coefficients[columns]) ** 2
    return covariance


def _told(selected: SelectedCauses, twist: SelectedTwist, unsure: float, paths: bool) -> LinkSide:
    rows, best, problem = twist.rows, twist.best, twist.problem
    zero = float(twist.coefficients[0])
    unit = "m" if selected.rows.layout.arm.sliding[rows.joint] else "rad"
    ridge = np.full(len(problem.scale), 1e12)
    ridge[best.columns] = best.noise**2 / best.variance
    members = [problem.space.candidates[effect.candidate].columns for effect in best.chosen]
    curves = [n for n, effect in enumerate(best.chosen) if rows.placed[effect.candidate + 1].cause is NAMELESS]
    explained = shares(problem.equations, ridge, rows.at[0], members, curves) if members else list[float]()
    causes = [
        _cause(selected, twist, effect.candidate, (float(share), unsure, agreement_of(twist, paths, effect.candidate)))
        for effect, share in zip(best.chosen, explained, strict=True)
    ]
    rms = _spread(rows.measured)
    error = float(np.sqrt(_covariance(twist, 0, unsure)[0, 0]))
    causes.sort(key=lambda cause: -cause.share)
    offset = Parameter("offset", unit, zero, error)
    return LinkSide(f"joint {rows.joint + 1}", offset, rms, rms * _held_out(twist), unit, tuple(causes))


def _cause(
    selected: SelectedCauses, twist: SelectedTwist, number: int, known: tuple[float, float, PathAgreement]
) -> FoundCause:
    (share, unsure, agreed), rows, arm = known, twist.rows, selected.rows.layout.arm
    placed, search = rows.placed[number + 1], Search.on(twist.problem)
    rivals = search.additions(search.without(twist.best, [number]), TELLING.looked_at, [number])
    parameters = _parameters(placed, twist.coefficients[rows.at[number + 1]], _covariance(twist, number + 1, unsure))
    doubts = []
    if agreed.undetermined:
        doubts.append("Undetermined: by themselves, no two parts of the motion tell its size.")
    if placed.cause is ELASTICITY:
        compliance = float(twist.coefficients[rows.at[number + 1]][0])
        doubts += too_loose(swing_of(selected.rows, rows.joint, max(compliance, 1e-300)))
    made = rows.columns[:, rows.at[number + 1]] @ twist.coefficients[rows.at[number + 1]]
    return FoundCause(
        effect=placed.cause.name,
        location=placed.location,
        family=placed.cause.family,
        driver=placed.driver,
        title=f"the link at {placed.location} by its {placed.driver}" if placed.cause is NAMELESS else title(placed),
        minor=min(share, (_spread(made) / _spread(rows.measured)) ** 2) < TELLING.minor_share,
        parameters=parameters,
        rms=_spread(made),
        unit="m" if arm.sliding[rows.joint] else "rad",
        joint=placed.location,
        share=share,
        evidence_nats=float(search.log_odds(twist.best, number)),
        alternatives=listed_rivals(search, twist.best, number, rivals),
        carries_over=agreed.words,
        consistent=agreed.consistent,
        physics=placed.cause.physics,
        confirm=placed.cause.confirm,
        cure=cure(placed, parameters, arm),
        doubt=" ".join(doubts),
    )


def _spread(values: Array) -> float:
    return float(np.std(values))


def _parameters(placed: PlacedCause, values: Array, covariance: Array) -> tuple[Parameter, ...]:
    """Its numbers; of a drive that winds up its stiffness first, by the error of its inverse to first order."""
    errors = np.sqrt(np.diag(covariance))
    told = tuple(
        Parameter(name, unit, float(value), float(error))
        for (name, unit), value, error in zip(placed.parameters, values, errors, strict=True)
    )
    if placed.cause is ELASTICITY:
        angle, _, torque = placed.parameters[0][1].partition("/")
        stiffness = 1 / max(float(values[0]), 1e-300)
        unit = f"{torque.strip('()')}/{angle}"
        told = (Parameter("stiffness", unit, stiffness, stiffness**2 * float(errors[0])), *told)
    return (*told, *(Parameter(name, unit, value, float("nan")) for name, unit, value in placed.scanned))


def _held_out(twist: SelectedTwist) -> float:
    """What is left of blocks by numbers from the others, over what a zero from the others leaves, RMS."""
    left, plain, problem, best = 0.0, 0.0, twist.problem, twist.best
    for held, block in enumerate(twist.blocks):
        rest = problem.with_equations(total([other for n, other in enumerate(twist.blocks) if n != held]))
        apart = block.scaled(problem.scale)
        for chosen in (best.chosen, ()):
            fitted = evaluate(rest, chosen, best.background, best.noise)
            rss = apart.rss(fitted.coefficients(len(problem.scale)))
            left, plain = (left + rss, plain) if chosen else (left, plain + rss)
    return float(np.sqrt(max(left, 0.0) / plain)) if best.chosen and plain > 0 else 1.0


def with_links(verdict: MotionVerdict, sides: Sequence[LinkSide]) -> MotionVerdict:
    """The verdict with what was found of links: they come first in its sentence, and count in its answer.

    Args:
        verdict: of the torques.
        sides: of the links.

    Returns:
        Both.
    """
    main = sorted((c for side in sides for c in side.causes if not c.minor), key=lambda cause: -cause.rms)
    if not main:
        return replace(verdict, links=tuple(sides))
    share = [f"{percent(cause.share)} of what its link lies beside its motor" for cause in main]
    told = [f"{clause(c)} – {of}{', in doubt' if c.doubt else ''}" for c, of in zip(main, share, strict=True)][
        : TELLING.in_headline
    ]
    torque = verdict.headline.replace("Nothing is missing", "In the torques nothing is missing")
    return replace(
        verdict,
        links=tuple(sides),
        headline=f"{capitalised('; '.join(told))}. {torque}",
        answer=_both(verdict.answer, main),
        mismatch=True,
    )


def _both(answer: Answer, main: Sequence[FoundCause]) -> Answer:
    nameless = any(cause.nameless for cause in main)
    if answer == "nothing missing":
        return "explained" if not nameless else "partly explained" if len(main) > 1 else "cannot tell"
    if answer == "explained" and nameless:
        return "partly explained"
    return "partly explained" if answer == "cannot tell" and not nameless else answer
