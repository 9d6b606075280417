"""A drive that gives way by more in some rows than in others: the warmer it is, or since something worked loose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from armscope.physics.clause import Told
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.drift import from_then_on, moment, when
from armscope.physics.effect import Driver, Effect, Placed, motor, term
from armscope.physics.elastic import loaded_joints, plausible_give
from armscope.physics.form_constants import FORM
from armscope.physics.placing import varies
from armscope.physics.scene import Scene
from armscope.physics.set_ups import in_order_of_time
from armscope.recordings import Recordings
from armscope.robot import Arm


def _place(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    """With the temperature, and from some run on; within a run the moment is scanned by the diagnosis."""
    if not arm.has_masses and recordings.torque is None:
        return
    scene, runs = Scene(arm, recordings), in_order_of_time(recordings)
    for j in loaded_joints(scene):
        if varies(recordings.temperature, FORM.least_span_k):
            yield _softening(scene, j)
        for number, (before, after) in enumerate(pairwise(runs), 1):
            told = f"between runs {before} and {after}"
            yield _looser(plausible_change(scene, j), j, Driver("during run", tuple(runs[number:])), told, variant=told)


def _softening(scene: Scene, j: int) -> Placed:
    warm = _load_while(j, Driver("warmth"))
    size = plausible_give(PLAUSIBLE.softening_share * PLAUSIBLE.drive_rad, scene.driver(warm))
    per_kelvin = term("give_per_k", "rad/(N m K)", (motor(j), warm), plausible=size)
    return Placed(WITH_TEMPERATURE, f"joint {j}", (per_kelvin,), (1.0,), "temperature", variant="temperature")


def plausible_change(scene: Scene, j: int) -> float:
    """By how much more or less a motor's drive may give way from some moment on, rad/(N m)."""
    return plausible_give(PLAUSIBLE.softening_share * PLAUSIBLE.drive_rad, scene.driver(Driver("torque", (j,))))


def compliance_change(recordings: Recordings, row: int, multiplicity: int, j: int, plausible: float) -> Placed:
    """The drive of motor j gives way by more or less from a row (0-based) on, and in all later runs.

    Args:
        recordings: the table.
        row: the first after the change.
        multiplicity: how many moments and motors compete.
        j: the motor, from 1.
        plausible: from `plausible_change`.

    Returns:
        The effect in place.
    """
    runs = in_order_of_time(recordings)
    start = moment(recordings, row, tuple(runs[runs.index(str(recordings.run[row])) + 1 :]))
    return from_then_on(
        _looser(plausible, j, start.driver, "", multiplicity=multiplicity * FORM.sessions_per_loosening), start
    )


def _looser(plausible: float, j: int, driver: Driver, told: str, variant: str = "", multiplicity: int = 1) -> Placed:
    change = term("give", "rad/(N m)", (motor(j), _load_while(j, driver)), plausible=plausible)
    return Placed(COMPLIANCE_CHANGE, f"joint {j}", (change,), (1.0,), told, variant=variant, multiplicity=multiplicity)


def _load_while(j: int, driver: Driver) -> Driver:
    return Driver("both", (Driver("torque", (j,)), driver))


def _more_or_less(value: float) -> str:
    return "more" if value > 0 else "less"


def _with_warmth(told: Told) -> str:
    give = told.numbers["give_per_k"]
    return f"{told.location} gives way by {give} {_more_or_less(give.value)} the warmer it is"


def _since(told: Told) -> str:
    give = told.numbers["give"]
    since = when(told)
    since = since.replace(" at ", " from ", 1) + " on" if since.startswith(" at ") else since
    return f"{told.location} gives way by {give} {_more_or_less(give.value)}{since}"


COMPLIANCE_CHANGE = Effect(
    "compliance_change",
    "elastic",
    _place,
    "The joint's drive gives way by more, or by less, from some moment on: bolts or a clamp worked loose, or were "
    "fastened.",
    "Hang a known weight on the tool, take it off, and see how far the joint turns; look for loose bolts of drive and "
    "bearing, and into the log for what was done then.",
    command(
        "Fasten what worked loose and measure anew;",
        otherwise="or compensate for it in the command: commanded = wanted - give x load x after (load: gravity's "
        "torque on this motor, positive along its pull; after: 0 before that moment, 1 from then on).",
        change="drive",
        instruction="Find what worked loose, or was fastened, at {location} then; measure again once it is as it is to "
        "stay.",
    ),
    clauses=(_with_warmth, _since, "{location} gives way by more in some rows than in others"),
    labels={"give": "gives way by more", "give_per_k": "gives way by more, per kelvin above 20 °C"},
    atlas="time",
    needs=("time_s, or rows in order",),
    departs=True,
    jumps=True,
    several=True,
)

WITH_TEMPERATURE = replace(
    COMPLIANCE_CHANGE,
    physics="The joint's drive gives way by more, or by less, the warmer it is: grease, a belt, rubber, preload.",
    confirm="Hang a known weight on the tool, cold and warm, and see how far the joint turns each time.",
    cure=command(
        "Keep the joint at one temperature;",
        otherwise="or compensate for it in the command: commanded = wanted - give_per_k x load x (temperature - 20 C) "
        "(load: gravity's torque on this motor, positive along its pull).",
        change="elastic model",
        instruction="Let what holds {location} against gravity follow the temperature (its formula stands beside), or "
        "keep it at one temperature.",
    ),
    atlas="temperature",
    needs=("temperature_c",),
    jumps=False,
)
"""The same with the temperature."""

EFFECTS = [COMPLIANCE_CHANGE]
