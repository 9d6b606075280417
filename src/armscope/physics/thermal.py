"""Thermal effects: links that grow or bow with temperature, and zeros that move; as stated they are at 20 C."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from armscope.physics.clause import below_zero, clear_ones
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.effect import ONE, Cure, Direction, Driver, Effect, Placed, Product, motor, term
from armscope.physics.form_constants import FORM
from armscope.physics.placing import moving_joints, varies
from armscope.recordings import Recordings
from armscope.robot import Arm

WARMTH = Driver("warmth")
"""Kelvin above 20 C."""
KEPT_WARM = (
    "It counts from 20 C: an arm that is only warmed up before work misses by all of it, and to keep it at one "
    "temperature helps only with a calibration at that temperature."
)
"""What is said beside every thermal cure: an arm that was only warmed up before work missed by more than a cold one."""
BY_MODEL = "let `armscope compensate` compute the commands (`temperature_c` in the path)"


def _place_links(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not varies(recordings.temperature, FORM.least_span_k):
        return
    for place, products in growing_links(arm, WARMTH):
        coefficient = term("coefficient", "1/K", *products, plausible=PLAUSIBLE.expansion_per_k)
        yield Placed(THERMAL_EXPANSION, place, (coefficient,), (1.0,), "temperature")


def all_links_growing(arm: Arm, recordings: Recordings) -> list[Placed]:
    """What every arm does in a hall whose temperature changes: its links grow, nearly alike.

    Args:
        arm: the nominal arm.
        recordings: the table, with temperatures.

    Returns:
        The growth of all links as of one material, then by how much each one's differs; none where the temperature
        hardly changes, or one link alone is long enough to be seen growing.
    """
    links = list(_place_links(arm, recordings))
    if len(links) < 2:
        return []
    products = tuple(product for link in links for product in link.terms[0].products)
    alike = term("growth", "1/K", *products, plausible=PLAUSIBLE.expansion_per_k)
    whole = replace(links[0], location="arm", terms=(alike,), prior_scale=(PLAUSIBLE.expansion_per_k,))
    return [whole, *(replace(link, prior_scale=(PLAUSIBLE.uneven_expansion_per_k,)) for link in links)]


def growing_links(arm: Arm, driver: Driver) -> Iterator[tuple[str, tuple[Product, ...]]]:
    """Links long enough to be seen growing, and how they do, in shares of their length per unit of a driver."""
    for j in range(1, arm.n_joints + 1):
        products = tuple(Product(direction, driver, length) for direction, length in _lengths(arm, j) if length)
        if sum(abs(product.factor) for product in products) > FORM.shortest_growing_m:
            yield f"link {j}", products


def _lengths(arm: Arm, j: int) -> list[tuple[Direction, float]]:
    """Directions along which row j grows and its length there, m."""
    if arm.description.dh is None:
        step = arm.before[j - 1][:3, :3].T @ arm.before[j - 1][:3, 3]
        return [(Direction(f"joint {j}", axis), float(s)) for axis, s in zip(("tx", "ty", "tz"), step, strict=True)]
    row = arm.description.dh.joints[j - 1]
    across = (f"link {j - 1}" if j > 1 else "base") if arm.is_modified_dh else f"link {j}"
    return [(Direction(across, "tx"), row.a_mm * 1e-3), (Direction(f"joint {j}", "tz"), row.d_mm * 1e-3)]


THERMAL_EXPANSION = Effect(
    "thermal_expansion",
    "thermal",
    _place_links,
    "The link grows with temperature (steel 11-12, aluminium 23-24 millionths per K).",
    "Measure one pose cold and warm, with a thermometer on the link.",
    Cure(
        "Scale the link in the controller's model with its temperature at work.",
        otherwise="Its length = stated length x (1 + coefficient x (temperature - 20 C)), for a and d of its row "
        f"alike; its inverse kinematics then reaches the wanted point. Or {BY_MODEL}. {KEPT_WARM}",
        change="temperature",
        instruction="Scale {location} in the controller's model with its temperature at work.",
    ),
    clauses=(
        below_zero("coefficient", "{location} shrinks by {coefficient} as it gets warmer"),
        "{location} grows by {coefficient} with temperature",
    ),
    labels={"coefficient": "expansion coefficient"},
    atlas="temperature",
    needs=("temperature_c",),
)


def _place_bows(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not varies(recordings.temperature, FORM.least_span_k):
        return
    for place, _ in growing_links(arm, ONE):
        behind = place.replace("link", "joint") if arm.links_come_first else place
        terms = tuple(
            term(f"tilt_{axis[1]}", "rad/K", (Direction(behind, axis), WARMTH), plausible=PLAUSIBLE.warm_rad_per_k)
            for axis in ("rx", "ry")
        )
        yield Placed(THERMAL_BOW, place, terms, (1.0, 1.0), "temperature")


THERMAL_BOW = Effect(
    "thermal_bow",
    "thermal",
    _place_bows,
    "The link bows as it gets warmer: one side is warmer than the other, or of another material.",
    "Put a thermometer on both sides of the link, and measure one pose cold and warm.",
    Cure(
        "Tilt the link's end in the controller's model with its temperature at work.",
        otherwise="Its turn = tilt_x x (temperature - 20 C) about its x, tilt_y x (temperature - 20 C) about its y; "
        f"the inverse kinematics then reaches the wanted point. Or {BY_MODEL}. Keep away what warms one side (a motor, "
        f"a draught, the sun), and measure again. {KEPT_WARM}",
        change="temperature",
        instruction="Tilt the end of {location} in the controller's model with its temperature at work.",
    ),
    clauses=(
        clear_ones("{location} bows {} as it gets warmer", tilt_x="about its x", tilt_y="about its y"),
        "{location} bows as it gets warmer",
    ),
    labels={"tilt_x": "tilt of its end about x", "tilt_y": "about y"},
    atlas="temperature",
    needs=("temperature_c",),
)


RIGHT_ELSEWHERE = "right at another temperature"
"""The variant of a zero that moves and was not set at 20 C: joints are calibrated when somebody comes by."""


def _place_zeros(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    if not varies(recordings.temperature, FORM.least_span_k):
        return
    for j in moving_joints(recordings):
        drift = term("drift", "rad/K", (motor(j), WARMTH), plausible=PLAUSIBLE.warm_rad_per_k)
        yield Placed(THERMAL_ZERO, f"joint {j}", (drift,), (1.0,), "temperature")
        offset = term("offset", "rad", (motor(j), ONE), plausible=PLAUSIBLE.warm_rad_per_k * PLAUSIBLE.set_within_k)
        both = (drift, offset)
        yield Placed(THERMAL_ZERO, f"joint {j}", both, (1.0, 1.0), "temperature", variant=RIGHT_ELSEWHERE)


THERMAL_ZERO = Effect(
    "thermal_zero",
    "thermal",
    _place_zeros,
    "The joint's zero moves as it gets warmer: what holds its encoder, its gear or its belt grows.",
    "Bring the joint to its calibration mark cold and warm, with a thermometer on its housing.",
    command(
        "Compensate for it in the command, with the temperature at work.",
        otherwise="That is, commanded = wanted - drift x (temperature - 20 C) - offset (no offset where none is told). "
        f"{KEPT_WARM}",
        change="temperature",
        instruction="With the temperature at work, {correction}.",
    ),
    clauses=(
        "the zero of {location} moves by {drift:+}, and is off by {offset:+} at 20 °C",
        "the zero of {location} moves by {drift:+}",
    ),
    labels={"drift": "zero moves by", "offset": "zero is off at 20 °C by"},
    atlas="temperature",
    needs=("temperature_c",),
    contained_in=("temperature",),
)

EFFECTS = [THERMAL_EXPANSION, THERMAL_BOW, THERMAL_ZERO]
