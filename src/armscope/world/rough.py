"""Arms as rough as real ones: each assumption that the columns of a diagnosis rest on is broken at random, on its own.

What is here is no story (but for a misread row and unstated bars): every effect stands in truth.yaml as `minor`, with
its true name and size, so that naming it is right and leaving it out is right, too. What is told wrongly of an arm (its
masses, its bars) and how its instrument errs are here as well. All sizes are `armscope.world.constants.ROUGH`'s:
assumptions, each with its basis.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import Parallelogram, RobotDescription
from armscope.world.constants import ROUGH, Pair
from armscope.world.imperfections import (
    BEARING,
    DRIVE,
    FINE_WAVES,
    GROWTH,
    LINK,
    LOW_WAVES,
    OF,
    PAYLOAD_SHARE,
    PEDESTAL,
    ROW,
    RUNS,
    WANDER,
)
from armscope.world.kinds import LOAD, PAYLOAD, Concealed, Scene, joints, links_longer_than
from armscope.world.strength import Sized, equilibrium, rms_after_frames

Drawn = list[Concealed]
LINK_VALUES = ("alpha", "a", "d", "beta")
LONG_LINK_M = 0.1


def between(rng: np.random.Generator, pair: Pair) -> float:
    """A size of a pair, evenly on a logarithmic scale."""
    return float(np.exp(rng.uniform(*np.log(pair))))


def _seed(rng: np.random.Generator) -> float:
    return float(rng.integers(2**31))


def _gears(rng: np.random.Generator, scene: Scene) -> Drawn:
    """A falling spectrum in every gear; its first two waves have a name of their own."""
    found = []
    for place in joints(scene.description):
        whole, slope = between(rng, ROUGH.gear_rad), rng.uniform(*ROUGH.gear_slope)
        for kind, first, last in ((LOW_WAVES, 1, 2), (FINE_WAVES, 3, ROUGH.gear_waves)):
            power = np.arange(1, ROUGH.gear_waves + 1) ** (-2 * slope)
            rms = whole * np.sqrt(power[first - 1 : last].sum() / power.sum())
            values = {"rms": rms, "first": first, "last": last, "slope": slope, "seed": _seed(rng)}
            found.append(Concealed(kind, place, {name: float(value) for name, value in values.items()}))
    return found


def _lines(rng: np.random.Generator, scene: Scene) -> Drawn:
    """A strain-wave gear's own line in every joint."""
    return [
        Concealed(
            OF["gear_mesh"],
            place,
            {
                "amplitude": between(rng, ROUGH.line_rad),
                "phase": float(rng.uniform(-np.pi, np.pi)),
                "per_turn": float(2 * round(between(rng, ROUGH.lines) / 2)),
            },
        )
        for place in joints(scene.description)
    ]


def _springs(rng: np.random.Generator, scene: Scene) -> Drawn:
    """Drives that harden, bearings that tilt more about one axis than about the other, links that bend."""
    largest = float(scene.torque_scale.max())
    found = []
    for motor, place in enumerate(joints(scene.description)):
        if scene.loads(motor):
            turn, soft = between(rng, ROUGH.drive_rad), between(rng, ROUGH.softness)
            compliance = turn * (1 - soft) / scene.largest_torque(motor)
            values = {"compliance": compliance, "soft": turn * soft, "knee": between(rng, ROUGH.knee_share)}
            found.append(Concealed(DRIVE, place, values))
        soft = between(rng, ROUGH.bearing_rad) / largest
        stiff = soft / between(rng, ROUGH.bearing_ratio)
        about_x, about_y = rng.permutation([soft, stiff]).tolist()
        found.append(Concealed(BEARING, place, {"about_x": about_x, "about_y": about_y}))
    for place in links_longer_than(LONG_LINK_M)(scene.description):
        # a beam turns at its end by L / (2 E I) to L / (E I) times the moment
        found.append(Concealed(OF["link_bending"], place, {"flexibility": between(rng, ROUGH.bearing_rad) / largest}))
    return found


def _pedestal(rng: np.random.Generator, scene: Scene) -> Drawn:
    """Softer about one axis than across, and turned against the arm's zero."""
    soft = between(rng, ROUGH.pedestal_rad) / float(scene.torque_scale.max())
    direction, ratio = float(rng.uniform(0, np.pi)), between(rng, ROUGH.pedestal_ratio)
    return [Concealed(PEDESTAL, "base", {"soft": soft, "stiff": soft / ratio, "direction": direction})]


def _bars(rng: np.random.Generator, scene: Scene) -> Drawn:
    if scene.description.parallelogram is None:
        return []
    rod, rocker = (float(rng.choice([-1, 1])) * between(rng, ROUGH.bar_m) for _ in range(2))
    return [Concealed(OF["parallelogram_geometry"], "parallelogram", {"rod": rod, "rocker": rocker})]


def _geometry(rng: np.random.Generator, scene: Scene) -> Drawn:
    """Every D-H value, every zero, and the turn about y that no D-H row has."""
    size = between(rng, ROUGH.length_m)
    zeros = [Concealed(OF["joint_offset"], p, {"offset": rng.normal(0, size)}) for p in joints(scene.description)]
    links = [
        Concealed(
            LINK, place.replace("joint", "link"), dict(zip(LINK_VALUES, rng.normal(0, size, 4).tolist(), strict=True))
        )
        for place in joints(scene.description)
    ]
    return zeros + links


def _row(rng: np.random.Generator, scene: Scene) -> Drawn:
    """An offset that belongs to one D-H row and is stated on the next; the first row's may be the base's."""
    row = int(rng.integers(2, len(joints(scene.description))))
    size = between(rng, ROUGH.row_m)
    return [Concealed(ROW, f"link {row + after}", {"a": size if after == 0 else -size}) for after in (0, 1)]


def _wander(rng: np.random.Generator, scene: Scene) -> Drawn:
    return [Concealed(WANDER, "base", {"size": between(rng, ROUGH.wander_m), "seed": _seed(rng)})]


def _runs(rng: np.random.Generator, scene: Scene) -> Drawn:
    return [Concealed(RUNS, "base", {"size": between(rng, ROUGH.run_m), "seed": _seed(rng)})]


def _day(rng: np.random.Generator, scene: Scene) -> Drawn:
    """Links that grow, later than the hall warms up."""
    growth, lag = between(rng, ROUGH.growth_per_k), between(rng, ROUGH.lag_s)
    places = links_longer_than(LONG_LINK_M)(scene.description)
    return [Concealed(GROWTH, place, {"coefficient": growth, "lag": lag}) for place in places]


def _play(rng: np.random.Generator, scene: Scene) -> Drawn:
    return [Concealed(OF["backlash"], p, {"gap": between(rng, ROUGH.play_rad)}) for p in joints(scene.description)]


def _payload(rng: np.random.Generator, scene: Scene) -> Drawn:
    share = float(rng.choice([-1, 1])) * between(rng, ROUGH.payload_share)
    return [Concealed(PAYLOAD_SHARE, "payload", {"share": share})]


def _told_elsewhere(rng: np.random.Generator, scene: Scene) -> Drawn:
    return []


BLEMISHES: dict[str, tuple[float, Callable[[np.random.Generator, Scene], Drawn]]] = {
    "masses": (0.7, _told_elsewhere), "payload": (0.4, _payload), "pedestal": (0.6, _pedestal), "bars": (0.7, _bars),
    "gears": (0.8, _gears), "lines": (0.5, _lines), "springs": (0.8, _springs), "geometry": (0.9, _geometry),
    "row": (0.06, _row), "instrument": (0.6, _told_elsewhere), "wander": (0.6, _wander), "runs": (0.4, _runs),
    "day": (0.5, _day), "play": (0.5, _play),
}  # fmt: skip
"""What may be rough: how often it is, and what it conceals.

| name | the assumption that it breaks |
|---|---|
| masses | stated masses are right |
| payload | stated payloads are right |
| pedestal | a base gives way alike about x and y, or has its soft axis along one of them |
| bars | a parallelogram's bars are stated (the arms that have one) |
| gears | a gear errs in one or two waves |
| lines | a gear's lines have fewer than a hundred waves per turn |
| springs | one thing gives way, in proportion, or hardens at a known load |
| geometry | D-H rows can say every error |
| row | rows are in one convention |
| instrument | noise is Gaussian, alike in all directions and at all distances |
| wander | a set-up stands still or drifts evenly |
| runs | the base stands still between runs |
| day | links are as warm as the hall |
| play | there is none where none is large |
"""


NOT_WRONG = {"masses": ("payload_error", "payload"), "day": ("instrument_scale", "instrument")}
"""Names that are as good as the blemish's own: who carries what weighs more than is stated may blame the payload, and
an arm that is warm all over is a scale."""


def draw_broken(rng: np.random.Generator) -> list[str]:
    """Names of what is rough in an arm, each drawn on its own."""
    return [name for name, (share, _) in BLEMISHES.items() if rng.random() < share]


def blemishes(scene: Scene, broken: tuple[str, ...], rng: np.random.Generator) -> list[Sized]:
    """What is rough in an arm, with its size at the tool.

    Args:
        scene: the rows over which sizes are taken.
        broken: names of `BLEMISHES`.
        rng: draws their numbers.

    Returns:
        Background effects; a misread row and unstated bars, which are causes; an error of the payload as it shows
        through the rest.
    """
    drawn = [effect for name in broken for effect in BLEMISHES[name][1](rng, scene)]
    rigid, springs = equilibrium(scene, []).tool, [effect for effect in drawn if effect.kind.driver == LOAD]
    found = []
    for effect in drawn:
        beside = springs if effect.kind.driver == PAYLOAD else []
        without = equilibrium(scene, beside).tool if beside else rigid
        tool = equilibrium(scene, [*beside, effect]).tool
        size = rms_after_frames(tool, without, scene.tool_turn)
        # who overlooks a row that is centimetres off, or bars off by all the arm's roughness, has seen nothing
        story = (effect.kind is ROW and effect.values["a"] > 0) or effect.location == "parallelogram"
        found.append(Sized(effect, size, tool - without, minor=not story))
    return found


def rough_description(
    description: RobotDescription, broken: tuple[str, ...], rng: np.random.Generator
) -> RobotDescription:
    """The true arm: with bars of its own, where they are not stated.

    Args:
        description: the arm as it is made.
        broken: names of `BLEMISHES`.
        rng: draws the bars.

    Returns:
        The arm.
    """
    if "bars" not in broken or description.parallelogram is None:
        return description
    bars = description.parallelogram
    rocker = bars.upper_arm_mm * between(rng, ROUGH.rocker_share)
    angle = bars.crank_angle_deg + float(rng.uniform(-10, 10))
    linkage = Parallelogram(
        crank_mm=rocker, rocker_mm=rocker, rod_mm=bars.rod_mm, upper_arm_mm=bars.upper_arm_mm, crank_angle_deg=angle
    )
    return description.model_copy(update={"parallelogram": linkage})


def as_stated(content: dict[str, Any], broken: tuple[str, ...], rng: np.random.Generator) -> dict[str, Any]:
    """robot.yaml as it is stated of a rough arm: masses off, bars left out.

    Args:
        content: of the true arm's file; it is changed.
        broken: names of `BLEMISHES`.
        rng: draws by how much.

    Returns:
        The content.
    """
    if "masses" in broken:
        for link in content["links"]:
            share = float(rng.choice([-1, 1])) * between(rng, ROUGH.mass_share)
            link["mass_kg"] = round(link["mass_kg"] * (1 + share), 3)
    if "bars" in broken:
        content.pop("parallelogram", None)
    return content


def rough_noise(points: Array, rng: np.random.Generator) -> Array:
    """(N, 3) noise of an instrument beside the arm at points (N, 3), m, in units of its sigma.

    It has Student's tails, is smaller along the line of sight and grows with the distance.
    """
    heading = rng.uniform(0, 2 * np.pi)
    station = points.mean(axis=0) + ROUGH.distance_m * np.array([np.cos(heading), np.sin(heading), 0.0])
    sight = points - station
    distance = np.linalg.norm(sight, axis=1, keepdims=True)
    sight /= distance
    noise = rng.standard_t(ROUGH.freedom, points.shape) / np.sqrt(ROUGH.freedom / (ROUGH.freedom - 2))
    noise -= (1 - ROUGH.radial) * np.sum(noise * sight, axis=1, keepdims=True) * sight
    return np.asarray(noise * distance / np.median(distance))
