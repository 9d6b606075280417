"""Free curves: structure that no physics of the library explains, located and followed, called `unknown`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.core.location import Location
from armscope.core.types import Array
from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.drift import six_terms
from armscope.physics.effect import ONE, Cure, Direction, Driver, Effect, Part, Placed, Product, Term, motor, term
from armscope.physics.elastic import drive, loaded_joints
from armscope.physics.form_constants import FORM
from armscope.physics.geometric import JOINT_OFFSET
from armscope.physics.placing import moving_joints, varies, varying_columns
from armscope.physics.recorded_drivers import REFERENCE_TEMPERATURE_C, SECONDS_PER_HOUR
from armscope.physics.scatter_words import SCATTER_CLAUSES, SCATTER_LABELS
from armscope.physics.scene import Scene
from armscope.physics.transmission import BACKLASH, GEAR_RATIO, wave_terms
from armscope.recordings import Recordings
from armscope.robot import Arm

CONTEXT = ("time", "temperature")
"""The variants of curves of what is recorded beside the angles; columns of the same name."""
REST_OF_LOAD = "rest of load"
"""The variant of a curve of load beside the line that it mostly is."""
OF_LOAD = ("load", REST_OF_LOAD)
"""Variants of curves whose line is a compliance, known by its direction."""


def waves(recordings: Recordings) -> int:
    """How many waves a free curve gets: what the number of rows carries."""
    return int(np.clip(len(recordings) // FORM.rows_per_wave, FORM.fewest_waves, FORM.most_waves))


def follows_own_angle(placed: Placed) -> bool:
    """Whether it is a free curve of a joint's own angle."""
    return placed.parametrisation == "curve" and placed.variant == "angle"


def spans_half_a_turn(curve: Placed) -> bool:
    """Whether a free curve of a joint's own angle was learned on half a turn at least.

    Over less, waves once and twice per turn are any smooth bend: four numbers that a cable or a hose needs, too.
    """
    slowest = min(p.driver.number(1) for t in curve.terms for p in t.products if p.driver.kind == "cosine")
    return slowest <= 2 / FORM.slack


def refined(arm: Arm, recordings: Recordings, curve: Placed) -> Placed | None:
    """A free curve of a joint's own angle with the finest waves that a long table carries; None for other curves.

    Args:
        arm: the nominal arm.
        recordings: the table.
        curve: a curve in place.

    Returns:
        The finer curve in place.
    """
    count = min(len(recordings) // FORM.rows_per_fine_wave, FORM.most_fine_waves)
    if not follows_own_angle(curve) or curve.refinement or count <= FORM.most_waves:
        return None
    j = Location.of(curve.location).number
    return replace(_angle_curve(arm, recordings, j, count, FORM.smooth_fine_waves), refinement=True)


def held(curve: Placed, recordings: Recordings) -> Placed:
    """A free curve of a joint's own angle, time or temperature, held at its end values beyond where it was learned.

    There its waves would only repeat, its bumps end, and its trend run on: a joint that had jumped to and fro was
    foretold to go on. Single rows far out (a home pose) are no part of the range.
    """
    if follows_own_angle(curve):
        ends = _range(recordings.motor_angles[:, Location.of(curve.location).number - 1])

        def bounded(driver: Driver) -> Driver:
            return driver if driver == ONE else Driver(driver.kind, (*driver.arguments, *ends))

    elif curve.parametrisation == "curve" and curve.variant in CONTEXT:
        values = getattr(recordings, curve.variant)
        known = values[~np.isnan(values)]

        def bounded(driver: Driver) -> Driver:
            return driver if driver == ONE else _bounded_within(driver, known)

    else:
        return curve

    def of_products(products: tuple[Product, ...]) -> tuple[Product, ...]:
        return tuple(replace(product, driver=bounded(product.driver)) for product in products)

    return replace(curve, terms=tuple(replace(each, products=of_products(each.products)) for each in curve.terms))


def _bounded_within(driver: Driver, known: Array) -> Driver:
    """A driver that follows time or temperature, or a bump of it, held at the ends of the values (N,) of its column."""
    if driver.kind == "spline" and isinstance(driver.arguments[0], Driver):
        return replace(driver, arguments=(_bounded_within(driver.arguments[0], known), *driver.arguments[1:]))
    start = driver.number(0) if driver.kind == "hours" else REFERENCE_TEMPERATURE_C
    unit = SECONDS_PER_HOUR if driver.kind == "hours" else 1.0
    return Driver("held", (driver, float((known.min() - start) / unit), float((known.max() - start) / unit)))


def about_its_mean(curve: Part, scene: Scene) -> tuple[Part, float]:
    """A free curve of a joint's own angle about its mean over the rows, and that mean, rad.

    A constant is the joint's zero, whoever holds it: geometry and base take it up, and where poses hardly tell it from
    them, it may be many times as large as all that follows the angle.

    Args:
        curve: a fitted curve.
        scene: the rows.

    Returns:
        The curve without its mean, and the mean; any other part as it is, and 0.
    """
    placed = curve.placed
    constant = [n for n, each in enumerate(placed.terms) if [product.driver for product in each.products] == [ONE]]
    if not follows_own_angle(placed) or len(constant) != 1:
        return curve, 0.0
    (turned,) = scene.amounts([curve]).values()
    mean, values = float(turned.mean()), curve.values.copy()
    values[constant[0]] -= mean
    return replace(curve, values=values), mean


def _range(values: Array) -> tuple[float, float]:
    """Smallest and largest value, isolated ones left out."""
    inside = np.sort(values)
    wide = FORM.isolated * (inside[-1] - inside[0])
    while len(inside) > 2 and inside[1] - inside[0] > wide:
        inside = inside[1:]
    while len(inside) > 2 and inside[-1] - inside[-2] > wide:
        inside = inside[:-1]
    return float(inside[0]), float(inside[-1])


def _place(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    yield from _own_angle(arm, recordings)
    yield from _load(arm, recordings)
    yield from _lost_motion(recordings)
    yield from _context(arm, recordings)


def _own_angle(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in moving_joints(recordings):
        yield _angle_curve(arm, recordings, j, waves(recordings), FORM.smooth_waves)


def _angle_curve(arm: Arm, recordings: Recordings, j: int, count: int, smooth: float) -> Placed:
    trend = [*JOINT_OFFSET.place(arm, recordings), *GEAR_RATIO.place(arm, recordings)]
    terms: list[Term] = [t for placed in trend if placed.location == f"joint {j}" for t in placed.terms]
    shape: list[float] = []
    longest = min(FORM.slack * float(np.ptp(recordings.motor_angles[:, j - 1])), 2 * np.pi)
    for number in range(1, count + 1):
        terms += wave_terms(j, number if longest == 2 * np.pi else number * 2 * np.pi / longest)
        shape += [1 / (1 + (number / smooth) ** 2)] * 2
    return _curve(f"joint {j}", tuple(terms), shape, f"angle of joint {j}", "angle", trends=2)


def _load(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not arm.has_masses and recordings.torque is None:
        return
    scene = Scene(arm, recordings)
    offsets = {placed.location: placed.terms for placed in JOINT_OFFSET.place(arm, recordings)}
    flanks = {p.location: p.terms for p in BACKLASH.place(arm, recordings) if p.variant == "load"}
    for j in loaded_joints(scene):
        source = Driver("torque", (j,))
        bumps = _spline_terms(source, scene.driver(source), motor(j), "rad", FORM.knots)
        linear = drive(scene, j, source)
        terms = (*offsets.get(f"joint {j}", ()), *flanks.get(f"joint {j}", ()), linear, *bumps)
        trends = len(terms) - len(bumps)
        yield _curve(f"joint {j}", terms, [1.0] * len(bumps), f"load of joint {j}", "load", trends)
        rest = _curve(f"joint {j}", bumps, [1.0] * len(bumps), f"load of joint {j}", REST_OF_LOAD)
        yield replace(rest, refinement=True)


def _lost_motion(recordings: Recordings) -> Iterator[Placed]:
    """Play that is not the same at all angles; sides that the order of rows alone tells are asked for plain play."""
    if recordings.sides_by_order:
        return
    moving = set(moving_joints(recordings))
    for j in varying_columns(recordings.approach, 0.5):
        if j in moving:
            gap = term("gap", "rad", Product(motor(j), Driver("approach", (j,)), -0.5), plausible=PLAUSIBLE.play_rad)
            bumps = tuple(
                term(f"at_{n}", "rad", (motor(j), Driver("lost motion", (j, centre, width))))
                for n, (centre, width) in enumerate(_knots(recordings.motor_angles[:, j - 1], FORM.knots))
            )
            driver = f"side of approach and angle of joint {j}"
            yield _curve(f"joint {j}", (gap, *bumps), [1.0] * len(bumps), driver, "approach", trends=1)


def _context(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """Base and joints that move with time or temperature, not steadily."""
    offsets = {placed.location: placed.terms for placed in JOINT_OFFSET.place(arm, recordings)}
    for values, least, name, source in (
        (recordings.time, 1.0, "time", "hours"),
        (recordings.temperature, 0.2, "temperature", "warmth"),
    ):
        if not varies(values, least):
            continue
        assert values is not None
        start = float(np.nanmin(values))
        driver = Driver("hours", (start,)) if source == "hours" else Driver("warmth")
        drives = (values - start) / SECONDS_PER_HOUR if source == "hours" else values - REFERENCE_TEMPERATURE_C
        known = drives[~np.isnan(drives)]
        knots = _knots(known, FORM.context_knots)
        base = [t for centre, width in knots for t in six_terms("base", Driver("spline", (driver, centre, width)))]
        yield _curve("base", tuple(base), [1.0] * len(base), name, name)
        for j in moving_joints(recordings):
            terms = _spline_terms(driver, known, motor(j), "rad", FORM.context_knots)
            trend = (*offsets.get(f"joint {j}", ()), term("trend", "rad per driver", (motor(j), driver)))
            yield _curve(f"joint {j}", (*trend, *terms), [1.0] * len(terms), name, name, trends=len(trend))


def _curve(
    location: str, terms: tuple[Term, ...], shape: list[float], driver: str, variant: str, trends: int = 0
) -> Placed:
    """A free curve; its first ``trends`` terms are a constant or a trend, as large as all the rest together."""
    total = float(np.sqrt(np.sum(np.square(shape))))
    return Placed(
        UNKNOWN_OVER_TIME if variant == "time" else UNKNOWN,
        location,
        terms,
        (*[1.0] * trends, *(s / total for s in shape)),
        driver,
        variant=variant,
        parametrisation="curve",
        partly_unseen=True,
    )


def _spline_terms(source: Driver, values: Array, direction: Direction, unit: str, count: int) -> tuple[Term, ...]:
    """``count`` cubic B-splines over the range of a driver's values (N,), each a term in one direction."""
    return tuple(
        term(f"at_{n}", unit, (direction, Driver("spline", (source, centre, width))))
        for n, (centre, width) in enumerate(_knots(values, count))
    )


def _knots(values: Array, count: int) -> list[tuple[float, float]]:
    """(centre, width) of ``count`` splines that cover a range, the outer ones centred on its ends."""
    low, high = float(values.min()), float(values.max())
    width = (high - low) / (count - 1)
    return [(low + n * width, width) for n in range(count)]


def _column(told: Told) -> str:
    """The atlas' column of what a curve follows."""
    starts = {"angle of": "own angle", "load of": "gravity load", "time": "time", "temperature": "temperature"}
    return next((column for start, column in starts.items() if told.driver.startswith(start)), "")


UNKNOWN = Effect(
    "unknown",
    "unknown",
    _place,
    "Something here follows its driver in a way that none of the library's effects explains.",
    "Measure this joint alone in fine steps over the driver's range.",
    command(
        "Correct by the fitted curve (curves.csv) until its cause is found: commanded = wanted - curve.",
        change="correction table",
        instruction="Find what it follows; until then store its curve as a correction table.",
    ),
    clauses=(
        *SCATTER_CLAUSES,
        "something unexplained at {location} follows the {driver}, by up to {reaches}",
        "something unexplained at {location} follows the {driver}",
    ),
    labels=SCATTER_LABELS,
    atlas=_column,
    several=True,
)

UNKNOWN_OVER_TIME = replace(
    UNKNOWN,
    confirm="Repeat one pose through a whole session and watch what is named here: does it creep, or jump?",
    cure=Cure(
        "Find what moved: a clamp, coupling or encoder that slipped, or parts that warmed up. Fasten it, set its zero "
        "anew, and measure again.",
        otherwise="A curve over the time of these recordings corrects no later motion.",
        change="what moved",
        instruction="Find what moved during these recordings (a clamp, coupling or encoder that slipped, or parts that "
        "warmed up), fasten it, set its zero anew, and measure again.",
    ),
)
"""The same where it follows the time: no later session has that time, and no command can be corrected by it."""

EFFECTS = [UNKNOWN]
