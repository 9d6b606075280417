"""Transmission effects: what happens between the motor's commanded angle and the joint's true one."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from armscope.core.words import rounded
from armscope.physics.clause import Told, below_zero, swings, waves_column
from armscope.physics.constants import PLAUSIBLE
from armscope.physics.cure import command
from armscope.physics.effect import Driver, Effect, Placed, Product, Term, motor, term
from armscope.physics.form_constants import FORM
from armscope.physics.placing import moving_joints, nowhere, varying_columns
from armscope.physics.scene import Scene
from armscope.recordings import Recordings
from armscope.robot import Arm

MESH_COUNTS = range(3, 401)
"""Periods per joint turn that are tried for a gear mesh error: a strain wave gear makes two per turn of its motor."""


def wave_terms(j: int, per_turn: float) -> tuple[Term, Term]:
    """Cosine and sine of motor angle j, ``per_turn`` periods per turn, rad."""
    size = PLAUSIBLE.eccentricity_rad if per_turn <= FORM.eccentric_waves else PLAUSIBLE.mesh_rad
    return (
        term(f"cosine_{per_turn:g}", "rad", (motor(j), Driver("cosine", (j, per_turn))), plausible=size),
        term(f"sine_{per_turn:g}", "rad", (motor(j), Driver("sine", (j, per_turn))), plausible=size),
    )


def _place_ratios(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in moving_joints(recordings):
        ratio = term("ratio", "rad/rad", (motor(j), Driver("angle", (j,))), plausible=PLAUSIBLE.ratio)
        yield Placed(GEAR_RATIO, f"joint {j}", (ratio,), (1.0,), f"angle of joint {j}")


def _turns(told: Told) -> str:
    ratio = told.numbers["ratio"].value
    return f"{told.location} turns {rounded(100 * abs(ratio))} % too {'far' if ratio > 0 else 'little'}"


GEAR_RATIO = Effect(
    "gear_ratio",
    "transmission",
    _place_ratios,
    "The joint turns by a little more or less than commanded, in proportion to the angle.",
    "Turn the joint alone by a large angle and back and measure the angle turned with the tracker.",
    command(
        "Correct the gear ratio (or the belt's or encoder's scale) in the controller,",
        otherwise="or compensate for it in the command: commanded = wanted - ratio x wanted.",
        change="gear ratio",
        instruction="Multiply the stated ratio (motor turns per joint turn) of {location} by {ratio}.",
    ),
    clauses=(_turns,),
    labels={"ratio": "turns further by"},
    atlas="own angle",
    contained_in=("angle",),
    departs=True,
)


def _place_eccentricities(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in moving_joints(recordings):
        for per_turn in (1, 2):
            yield _cyclic(GEAR_ECCENTRICITY, j, per_turn, multiplicity=2)


def _cyclic(effect: Effect, j: int, per_turn: int, multiplicity: int) -> Placed:
    return Placed(
        effect,
        f"joint {j}",
        wave_terms(j, per_turn),
        (1.0, 1.0),
        f"angle of joint {j}",
        scanned=(("per_turn", "1/turn", per_turn),),
        multiplicity=multiplicity,
        variant=str(per_turn),
        parametrisation="sine",
    )


GEAR_ECCENTRICITY = Effect(
    "gear_eccentricity",
    "transmission",
    _place_eccentricities,
    "A gear or the encoder's disc sits off its centre, so the angle error repeats once or twice per joint turn.",
    "Turn the joint alone in steps of 10 degrees over its whole range and look for one or two waves per turn. On a "
    "wrist do it again with its hoses and cables hanging free: what goes then was their pull.",
    command(
        "Re-centre the encoder disc or gear,",
        otherwise="or store the wave as a correction table: "
        "commanded = wanted - amplitude x cos(per_turn x wanted - phase).",
        change="encoder or gear",
        instruction="Re-centre the encoder disc or gear of {location}, or {correction}.",
    ),
    clauses=(swings("the angle of {location} swings"),),
    several=True,
    atlas=waves_column,
    contained_in=("angle",),
)


@functools.cache
def cyclic(j: int, per_turn: int) -> Placed:
    """A wave of motor j, by the effect that makes so many per turn."""
    return _cyclic(GEAR_ECCENTRICITY if per_turn <= FORM.eccentric_waves else GEAR_MESH, j, per_turn, multiplicity=1)


@functools.cache
def mesh(j: int, per_turn: int) -> Placed:
    """A gear mesh error of motor j with ``per_turn`` periods per joint turn."""
    return _cyclic(GEAR_MESH, j, per_turn, multiplicity=len(MESH_COUNTS))


GEAR_MESH = Effect(
    "gear_mesh",
    "transmission",
    nowhere,  # its counts are scanned by the diagnosis
    "The teeth of a gear stage engage unevenly, so the angle error repeats many times per joint turn.",
    "Turn the joint alone in steps much finer than the period found and look for the wave.",
    command(
        "Compare the period with the gear stages' tooth counts; replace the stage,",
        otherwise="or store the wave as a correction: commanded = wanted - amplitude x cos(per_turn x wanted - phase).",
        change="gear stage",
        instruction="Find the gear stage of {location} that has so many waves per turn, and replace it.",
    ),
    clauses=(swings("the angle of {location} swings"),),
    several=True,
    contained_in=("angle",),
)


def _place_backlash(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    moving = set(moving_joints(recordings))
    for j in varying_columns(recordings.approach, 0.5):
        if j in moving:
            gap = term("gap", "rad", Product(motor(j), Driver("approach", (j,)), -0.5), plausible=PLAUSIBLE.play_rad)
            yield Placed(
                _BY_APPROACH, f"joint {j}", (gap,), (1.0,), f"{SIDE_OF_APPROACH} of joint {j}", variant="approach"
            )
    if arm.has_masses or recordings.torque is not None:
        scene = Scene(arm, recordings)
        for j in sorted(moving):
            if not is_pulled_both_ways(scene, j):
                continue  # gravity always pushes to one side: a constant
            gap = term("gap", "rad", Product(motor(j), Driver("load side", (j,)), 0.5), plausible=PLAUSIBLE.play_rad)
            yield Placed(
                _BY_GRAVITY, f"joint {j}", (gap,), (1.0,), f"side that gravity loads joint {j}", variant="load"
            )


def is_pulled_both_ways(scene: Scene, j: int) -> bool:
    """Whether motor j (from 1) is loaded from both sides in more than a few of the rows."""
    pulled = np.mean(scene.driver(Driver("load side", (j,))) > 0)
    return bool(min(pulled, 1 - pulled) >= FORM.least_other_side)


SIDE_OF_APPROACH = "side of approach"
_ADJUST = "Adjust or preload the gear; until then approach from one side,"
_GEAR_PLAY = {"change": "gear play", "instruction": "Adjust or preload the gear of {location}."}


def leads(told: Told) -> bool:
    """Whether play is told that by its column of approach would put the joint ahead of its command, as none can."""
    gap = told.numbers.get("gap")
    return gap is not None and gap.value < 0 and told.driver.startswith(SIDE_OF_APPROACH)


def _play(told: Told) -> str:
    words = "{location} has {gap} of play".format_map(told.words())
    return f"{words}, if its column of approach has the wrong sign" if leads(told) else words


BACKLASH = Effect(
    "backlash",
    "transmission",
    _place_backlash,
    "The gear has play: the joint rests on one flank or the other, by the side it came from or gravity pushes it to.",
    "Approach one pose from both sides of this joint and compare.",
    command(
        _ADJUST,
        otherwise="or compensate for the play in the command: where the motion decides, commanded = wanted + "
        "approach x gap / 2 (approach: +1 after a positive motion); where gravity does, commanded = wanted - side x "
        "gap / 2 (side: sign of the load along gravity's pull).",
        **_GEAR_PLAY,
    ),
    clauses=(_play, "{location} has play"),
    labels={"gap": "play"},
    atlas="side of approach",
    contained_in=("load", "approach"),
)
_REVERSED = replace(
    BACKLASH,
    physics="By the recorded side of approach this joint is ahead of its command, where play can only leave it behind: "
    "most likely the column has the wrong sign.",
    confirm="Approach one pose from both sides of the joint and compare: after a positive motion play leaves it short.",
    cure=command(
        "Turn the sign of this joint's approach column in the recordings (+1: the last motion was positive) and "
        "diagnose again. Where it is right as it is, the controller makes up for more play than there is: lower its "
        "backlash compensation;",
        otherwise="or, once the sign is turned, compensate for the play in the command: commanded = wanted - approach "
        "x gap / 2 (gap as it is told here, below zero; approach: +1 after a positive motion).",
        change="sign of its approach column",
        needs="once the play is adjusted or commanded away: a sign in a table moves nothing",
        instruction="Turn the sign of {location}'s approach column in the recordings (+1: the last motion was "
        "positive) and diagnose again before anything is done to the gear. If it is right as it is, lower the "
        "controller's backlash compensation.",
    ),
)
_BY_APPROACH = replace(
    BACKLASH,
    cure=command(
        _ADJUST,
        otherwise="or compensate for the play in the command, where the motion decides, as found here: commanded = "
        "wanted + approach x gap / 2 (approach: +1 after a positive motion).",
        **_GEAR_PLAY,
    ),
    below_zero=_REVERSED,
)
_BY_GRAVITY = replace(
    BACKLASH,
    cure=command(
        _ADJUST,
        otherwise="or compensate for the play in the command, where gravity decides, as found here: commanded = wanted "
        "- side x gap / 2 (side: sign of the load along gravity's pull).",
        **_GEAR_PLAY,
    ),
)


def _place_lags(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    for j in varying_columns(recordings.speed, 1e-4):
        delay = term("delay", "s", Product(motor(j), Driver("speed", (j,)), -1.0), plausible=PLAUSIBLE.delay_s)
        yield Placed(SERVO_LAG, f"joint {j}", (delay,), (1.0,), f"speed of joint {j}")


SERVO_LAG = Effect(
    "servo_lag",
    "transmission",
    _place_lags,
    "The joint runs behind its command in proportion to its speed.",
    "Measure one point at several speeds, or at standstill: the error must vanish there.",
    command(
        "Add velocity feed-forward,",
        otherwise="or give the instrument the right time stamp. By command: commanded = wanted + delay x speed.",
        change="controller",
        instruction="Add velocity feed-forward at {location}, or mend the instrument's time stamps.",
    ),
    clauses=(below_zero("delay", "{location} runs ahead by {delay}"), "{location} runs behind by {delay}"),
    labels={"delay": "runs behind by"},
    atlas="speed",
    needs=("dq_rad_s",),
)


def _place_couplings(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    moving = moving_joints(recordings)
    for j in moving:
        for k in moving:
            # a joint's own angle is a gear ratio
            if j != k:
                coupling = term("coupling", "rad/rad", (motor(j), Driver("angle", (k,))), plausible=PLAUSIBLE.ratio)
                yield Placed(JOINT_COUPLING, f"joint {j} from joint {k}", (coupling,), (1.0,), f"angle of joint {k}")


JOINT_COUPLING = Effect(
    "joint_coupling",
    "transmission",
    _place_couplings,
    "The joint turns a little whenever another motor does (shared wrist gears, hoses, cables).",
    "Turn the other motor alone over its range and watch this joint.",
    command(
        "Put minus the coefficient into the controller's wrist coupling table,",
        otherwise="or compensate for it in the command: commanded = wanted - coupling x other (other: the angle of the "
        "motor it follows).",
        change="coupling table",
        instruction="Add {coefficient} to what the controller's coupling table holds for {location}.",
    ),
    clauses=("{joint} turns by {coupling:+} of {source}",),
    departs=True,
)

EFFECTS = [GEAR_RATIO, GEAR_ECCENTRICITY, GEAR_MESH, BACKLASH, SERVO_LAG, JOINT_COUPLING]
