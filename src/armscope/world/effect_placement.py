"""From what a world is to conceal to concealed effects: where each one sits and how large it is."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from armscope.core.location import Location
from armscope.world.judge import Judge, Visibility
from armscope.world.kinds import CONSTANT, LOAD, PAYLOAD, Concealed, Kind, Scene, number
from armscope.world.spec import KINDS, EffectSpec, WorldSpec
from armscope.world.strength import Sized, carried, sized

LARGEST_FACTOR = 15.0
"""An effect sits where no more than this multiple of its natural size is needed, if there is such a place."""
LEAST_LEFT = 0.05  # Share of an effect's squared size that the effects already chosen must leave to see
STANDS_OUT, ABOVE_LARGEST = 2.5, 1.5
"""A cause is at least so many times as large at the tool as what is rough everywhere usually, and at most, is of its
kind; errors of D-H rows and zeros are one kind."""
TRIES = 4
TRIES_FOR_AMBIGUITY = 12


def choose(
    scene: Scene, judge: Judge, spec: WorldSpec, rough: Sequence[Sized], rng: np.random.Generator
) -> list[Sized]:
    """What is asked for, concealed, sized in multiples of the noise; background that can't be seen is left out.

    Args:
        scene: the recorded rows.
        judge: of what can be told apart there.
        spec: what is to be concealed; among inseparable worlds what can't be told apart, otherwise what can.
        rough: what the arm has everywhere; of it, the story's effects stand out, each in the place of its like.
        rng: draws places and numbers.

    Returns:
        The concealed effects, the story's first first.

    Raises:
        RuntimeError: the first effect of the story can't be had anywhere in this arm.
    """
    chosen: list[Sized] = list(rough)
    sigma = spec.sigma_mm * 1e-3
    for asked in spec.effects:
        if asked.minor:
            chosen += _background(scene, asked, chosen, sigma, rng)
        else:
            chosen += _of_the_story(scene, judge, asked, chosen, sigma, spec.category == "inseparable", rng)
    story = [size for size in chosen if not size.minor]
    small = [size for size in chosen if size.minor]
    return story + [size for size in small if not _taken(size.effect.kind, size.effect.location, story)]


def _background(
    scene: Scene, asked: EffectSpec, chosen: list[Sized], sigma: float, rng: np.random.Generator
) -> list[Sized]:
    kind = KINDS[asked.kind]
    assert asked.location is not None, "background has its places"
    if _taken(kind, asked.location, chosen) or not _loaded(scene, kind, asked.location):
        return []
    effect = Concealed(kind, asked.location, kind.draw(rng, scene, asked.location))
    size = sized(scene, effect, asked.strength * sigma, rounds=1, largest_factor=LARGEST_FACTOR)
    return [] if size is None else [replace(size, minor=True)]


# so many parameters: what is known of a world while it is drawn
def _of_the_story(
    scene: Scene,
    judge: Judge,
    asked: EffectSpec,
    chosen: list[Sized],
    sigma: float,
    ambiguous: bool,
    rng: np.random.Generator,
) -> list[Sized]:
    """The best of a few places: one where the answer is unique (or, if so wanted, isn't).

    None where the effects already there leave nothing of it: a world doesn't conceal the same displacement twice.
    """
    kind = KINDS[asked.kind]
    places = [asked.location] if asked.location else kind.places(scene.description)
    story = [size for size in chosen if not size.minor]
    places = [place for place in places if not _taken(kind, place, story) and _loaded(scene, kind, place)]
    wanted = max(asked.strength * sigma, _standing_out(kind, chosen))
    if kind.driver == PAYLOAD:
        return _payload_error(scene, kind, wanted, rng)
    tries = TRIES_FOR_AMBIGUITY if ambiguous else TRIES
    for largest_factor in (LARGEST_FACTOR, np.inf):
        found: list[Sized] = []
        order = itertools.islice(itertools.cycle(rng.permutation(places).tolist()), max(2 * tries, len(places)))
        for place in order:
            effect = Concealed(kind, place, kind.draw(rng, scene, place))
            size = sized(scene, effect, wanted, largest_factor=largest_factor)
            if size is None:
                continue
            visibility = judge.visibility(size, _others(size, chosen), sigma)
            if visibility.noncentrality < LEAST_LEFT * size.pattern.size * (size.rms / sigma) ** 2:
                continue
            found.append(size)
            if bool(visibility.alternatives) == ambiguous:
                return [size]
            if len(found) == tries:
                break
        if found:
            return [found[0]]
    if chosen:
        return []
    raise RuntimeError(
        f"{kind.name} at {asked.strength} times the noise can't be seen anywhere in {scene.description.name}"
    )


def _payload_error(scene: Scene, kind: Kind, wanted: float, rng: np.random.Generator) -> list[Sized]:
    """The payload's error and two joints that give way, without which nobody would see it."""
    spring = KINDS["joint_compliance"]
    loaded = sorted(range(len(scene.torque_scale)), key=lambda motor: -scene.torque_scale[motor])[:2]
    places = [f"joint {motor + 1}" for motor in sorted(loaded)]
    carriers = [Concealed(spring, place, spring.draw(rng, scene, place)) for place in places]
    effect = Concealed(kind, "payload", kind.draw(rng, scene, "payload"))
    size, alone = carried(scene, effect, carriers, wanted)
    return [size, *alone]


def _taken(kind: Kind, place: str, chosen: list[Sized]) -> bool:
    return any(size.effect.kind.effect == kind.effect and size.effect.location == place for size in chosen)


def _loaded(scene: Scene, kind: Kind, place: str) -> bool:
    """Whether gravity turns the motor that an effect of load is to sit at."""
    by_load = kind.driver == LOAD or kind.effect == "compliance_change"
    if not by_load or Location.of(place).kind != "joint" or kind.unloaded:
        return True
    return scene.loads(number(place))


def _standing_out(kind: Kind, chosen: list[Sized]) -> float:
    """The least size at the tool, m, at which an effect stands out of what the arm has of its kind everywhere."""
    constant = kind.driver == CONSTANT
    alike = [
        size.rms
        for size in chosen
        if size.minor and (size.effect.kind.effect == kind.effect or (constant and size.effect.kind.driver == CONSTANT))
    ]
    return max(STANDS_OUT * float(np.median(alike)), ABOVE_LARGEST * max(alike)) if alike else 0.0


def visibilities(judge: Judge, sizes: Sequence[Sized], chosen: Sequence[Sized], sigma: float) -> list[Visibility]:
    """How well some of the concealed effects can be found beside the others.

    Args:
        judge: of what can be told apart.
        sizes: which.
        chosen: the concealed effects.
        sigma: noise per axis, m.

    Returns:
        One per effect of ``sizes``.
    """
    return [judge.visibility(size, _others(size, chosen), sigma) for size in sizes]


def visibilities_in_runs(
    judge: Judge, chosen: list[Sized], known: Sequence[Visibility], sigma: float, run: NDArray[np.int64]
) -> list[Visibility]:
    """The same where the table says each row's run (N,), so that the base is free in each; ``known`` without it.

    Args:
        judge: of what can be told apart.
        chosen: the concealed effects.
        known: of `visibilities`.
        sigma: noise per axis, m.
        run: (N,) number of each row's run.

    Returns:
        One per effect.
    """
    return [
        judge.seen_in_runs(visibility, size, _others(size, chosen), sigma, run)
        for visibility, size in zip(known, chosen, strict=True)
    ]


def _others(size: Sized, chosen: Sequence[Sized]) -> list[Sized]:
    """The story's other effects, and errors of D-H rows that an arm has everywhere, unless it is one itself."""
    constant = size.effect.kind.driver == CONSTANT
    free = [other for other in chosen if not other.minor or (other.effect.kind.driver == CONSTANT and not constant)]
    return [other for other in free if other is not size]
