"""A moving world as two folders: what the diagnosis may see, and the sealed truth.

    visible/  robot.yaml (what the user believes), motions.csv, test_motions.csv (another path, without torques, and
              without the links' own encoders where motions.csv has them)
    sealed/   truth.yaml, test.csv (that path with torques, N m, also where the diagnosis gets currents; `moves1 ...`: 0
              where a joint stands, and its friction may be anything within its band)

truth.yaml: `effects` (effect, location, parameters, `strength` = RMS torque over noise at the joint where it is
largest, `rms_nm` there, `rms_rad` of a link beside its motor, `minor` where the other causes' names say it as well,
`alternatives` that are as good on these paths, by evidence), `background` (the arm's own friction and rotors, which
robot.yaml may or may not state), `noise_nm` per joint, `left_on_test_nm` per joint: what the truth itself leaves on the
held-out path (noise, and what the drives' filter rounds off), and `left_moving_nm`, the same where the joint moves;
`zeros_rad` of links' encoders beside their motors', none where links have none; `rough` what a rough arm has
everywhere, told like `effects`, `also_allowed` names that are no wrong ones there; `scoring`: category, seed,
circumstances.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from numpy.typing import NDArray

from armscope.core.files import write_table, write_yaml
from armscope.core.types import Array
from armscope.robot.description_file import load_description
from armscope.world.motion.catalogue import ARMS, KINDS, MotionSpec
from armscope.world.motion.kinds import Concealed
from armscope.world.motion.links import read_links
from armscope.world.motion.mechanism import stated_dynamics
from armscope.world.motion.recording import Recorded, record, table
from armscope.world.motion.rivals import Standing, small_standings, standings
from armscope.world.motion.rough import also_allowed, blemishes, changes_alone, paces_of
from armscope.world.motion.session import make_session
from armscope.world.motion.virtual_arm import ImpossibleEffect, Sized, VirtualArm, ordinary, place

FRICTION = ("rotor_inertia_kg_m2", "coulomb_nm", "viscous_nm_s_rad")
QUIETEST = 0.002  # Noise of a joint that hardly needs torque, as a share of its largest
DRAWS, QUIETER = 6, 0.7
"""Of arms and paths that are tried before an effect is given up, each recorded with so much of the noise before: what
is so many times the noise is less absurd then."""
STANDS = 0.01  # rad/s below which a joint stands: ten times the speed from which MuJoCo's dry friction is fully there
GAINS = (4.0, 14.0)  # N m/A at the joint's side, of arms of this class
GAIN_KNOWN = 0.03  # Share to which gains are stated where they are rough


@dataclass(frozen=True, eq=False)
class World:
    """A world in memory: the arm, what it conceals, what else would do, and what was recorded.

    ``zeros``: (n,) rad, of links' encoders beside their motors'; None where links have none. ``rough``: what it has
    everywhere, with what else each could be.
    """

    spec: MotionSpec
    arm: VirtualArm
    concealed: list[Sized]
    standings: list[Standing]
    torque: Array
    recorded: Recorded
    gains: Array | None
    zeros: Array | None = None
    rough: list[tuple[Sized, Standing]] = field(default_factory=list)


def make(spec: MotionSpec, robots: Path) -> World:
    """Make a world; the same spec gives the same numbers.

    Where the arm of the spec can't conceal what is asked for without being absurd, the next arm of the catalogue does,
    and where none can, one of another draw of its make and of its paths, recorded with less noise.

    Raises:
        ImpossibleEffect: the spec's effects can't be on any arm.
    """
    first: ImpossibleEffect | None = None
    for draw, arm in itertools.product(range(DRAWS), dict.fromkeys([spec.arm, *ARMS])):
        try:
            noise = spec.noise * QUIETER**draw
            return _make(spec.model_copy(update={"arm": arm, "noise": noise}), robots, draw)
        except ImpossibleEffect as error:
            first = first or error
    raise ImpossibleEffect(str(first)) from first


def _make(spec: MotionSpec, robots: Path, draw: int = 0) -> World:
    seeds = ([spec.seed, part, *([draw] if draw else [])] for part in range(7))
    arms, paths, places, noise, drives, rough, paces = map(np.random.default_rng, seeds)
    arm, plain = _plain(spec, robots, arms, paths, paces_of(spec.rough, len(spec.durations), paces))
    everywhere = blemishes(arm, spec.rough, rough)
    beside = arm.among(arm.torques(everywhere) - plain) if everywhere else arm
    concealed: list[Sized] = []
    for asked in spec.effects:
        concealed.append(place(beside, KINDS[asked.kind], asked.strength, asked.location, places, plain))
    present = [*everywhere, *(each.concealed for each in concealed)]
    torque = arm.torques(present) if present else plain
    gains = drives.uniform(*GAINS, len(arm.sigma)).round(2) if spec.current else None
    recorded = record(arm.session, torque, arm.sigma, spec.rate, noise, rough="noise" in spec.rough)
    zeros = None
    if spec.linked:
        lies = arm.beside_motors([each.concealed for each in concealed])
        links, zeros = read_links(arm.session, recorded.rows, lies, np.random.default_rng([spec.seed, 8]))
        recorded = replace(recorded, links=links)
    stand = standings(beside, concealed, spec.rate, plain)
    told = [each if each.concealed.kind.lies else arm.sized(each.concealed, each.change) for each in concealed]
    return World(spec, arm, told, stand, torque, recorded, gains, zeros, _small(arm, everywhere, spec.rate, plain))


def _small(arm: VirtualArm, everywhere: list[Concealed], rate: int, plain: Array) -> list[tuple[Sized, Standing]]:
    """What is rough in an arm, with its size, and what else each could be; masses' names stand for themselves."""
    changes = changes_alone(arm, everywhere, plain)
    sized = [arm.sized(each, change) for each, change in zip(everywhere, changes, strict=True)]
    of_joints = [each for each in sized if each.concealed.kind.changes is None]
    found = zip(of_joints, small_standings(arm, of_joints, rate, plain) if of_joints else [], strict=True)
    of_links = [(each, Standing([], float("inf"))) for each in sized if each.concealed.kind.changes is not None]
    return [*found, *of_links]


def _plain(
    spec: MotionSpec, robots: Path, arms: np.random.Generator, paths: np.random.Generator, paces: tuple[float, ...]
) -> tuple[VirtualArm, Array]:
    """An arm that conceals nothing, with its motion and noise, and its torques."""
    description = load_description(robots / f"{spec.arm}.yaml")
    dynamics = ordinary(stated_dynamics(description), arms)
    if spec.joint is not None and spec.joint >= dynamics.n_joints:
        raise ImpossibleEffect(f"{spec.arm} has no joint {spec.joint + 1} that could move by a rule")
    session = make_session(description, spec.durations, spec.rule, spec.joint, paths, paces)
    arm = VirtualArm(description, dynamics, session, np.ones(dynamics.n_joints), spec.stated)
    plain = arm.torques([])
    train = plain[~session.test]
    sigma = np.maximum(spec.noise * np.sqrt(np.mean(train**2, axis=0)), QUIETEST * np.abs(train).max(axis=0))
    return VirtualArm(description, dynamics, session, sigma, spec.stated), plain


def build(spec: MotionSpec, folder: Path, robots: Path) -> Path:
    """Make a world and write it; the same spec gives the same bytes.

    Args:
        spec: what to make.
        folder: where its folder (named by its id) goes.
        robots: folder of the arms' descriptions.

    Returns:
        The world's folder, with `visible` and `sealed`.
    """
    world = make(spec, robots)
    home = folder / spec.id
    rng = np.random.default_rng([spec.seed, 9])
    shown = {name: bool(rng.random() < 0.4) for name in ("temperature_c", "speed")}
    needed = {column for each in world.concealed for column in each.concealed.kind.needs}
    columns = tuple(name for name, drawn in shown.items() if drawn or name in needed)
    motions = table(world.arm.session, world.recorded, columns, world.gains)
    test = motions["run"] == "test"
    torques = [str(name) for name in motions if str(name).startswith(("tau", "current")) or "_link_" in str(name)]
    write_table(home / "visible" / "motions.csv", motions[~test])
    write_table(home / "visible" / "test_motions.csv", motions[test].drop(columns=torques))
    torques_read = table(world.arm.session, world.recorded, columns, None)
    moves = pd.DataFrame(_moves(world)[test].astype(int), index=torques_read.index[test])
    moves.columns = pd.Index([f"moves{j + 1}" for j in range(moves.shape[1])])
    write_table(home / "sealed" / "test.csv", torques_read[test].join(moves))
    write_yaml(home / "visible" / "robot.yaml", _visible_robot(robots / f"{world.spec.arm}.yaml", world))
    write_yaml(home / "sealed" / "truth.yaml", _truth(world))
    return home


def _moves(world: World) -> NDArray[np.bool_]:
    """(N, n) whether each joint moves in the recorded rows."""
    return np.asarray(np.abs(world.arm.session.speed[world.recorded.rows]) >= STANDS)


def _visible_robot(source: Path, world: World) -> dict[str, Any]:
    """robot.yaml as the user believes it: drawings of the links; friction of this arm, or none."""
    content: dict[str, Any] = yaml.safe_load(source.read_text(encoding="utf-8"))
    dynamics = world.arm.dynamics
    actual = zip(dynamics.rotor, dynamics.coulomb, dynamics.viscous, strict=True)
    for j, (drive, values) in enumerate(zip(content["drives"], actual, strict=True)):
        for name, value in zip(FRICTION, values, strict=True):
            drive.pop(name)
            if world.spec.stated:
                drive[name] = float(f"{value:.6g}")
        if world.gains is not None:
            known = GAIN_KNOWN if "gains" in world.spec.rough else 0.0
            drive |= {"gain_nm_per_a": float(world.gains[j]), "gain_uncertainty": known}
    return content


def _truth(world: World) -> dict[str, Any]:
    spec, dynamics, test = world.spec, world.arm.dynamics, world.arm.session.test[world.recorded.rows]
    both = sorted(zip(world.concealed, world.standings, strict=True), key=lambda pair: -pair[0].strength)
    noise, left = world.recorded.noise, world.recorded.left
    moves = _moves(world)[test]
    while_moving = np.sum(moves * left[test] ** 2, axis=0) / np.maximum(moves.sum(axis=0), 1)
    return {
        "mismatch": bool(world.concealed),
        "effects": [_effect(*each) for each in both],
        "background": [
            {
                "location": f"joint {j + 1}",
                "coulomb_nm": float(dynamics.coulomb[j]),
                "viscous_nm_s_rad": float(dynamics.viscous[j]),
                "rotor_inertia_kg_m2": float(dynamics.rotor[j]),
            }
            for j in range(dynamics.n_joints)
        ],
        "noise_nm": np.sqrt(np.mean(noise[~test] ** 2, axis=0)).round(6),
        "left_on_test_nm": np.sqrt(np.mean(left[test] ** 2, axis=0)).round(6),
        "left_moving_nm": np.sqrt(while_moving).round(6),
        "rough": [_effect(*each) for each in world.rough],
        "also_allowed": [list(name) for name in also_allowed(spec.rough, dynamics.n_joints)],
        "zeros_rad": [] if world.zeros is None else world.zeros.round(9),
        "scoring": {
            "category": spec.category,
            "arm": spec.arm,
            "seed": spec.seed,
            "fresh": spec.fresh,
            "rate_hz": spec.rate,
            "rows": int((~test).sum()),
            "stated": spec.stated,
            "current": spec.current,
            "rule": spec.rule,
            "rough": list(spec.rough),
            "outside_library": any(each.concealed.kind.outside for each in world.concealed),
        },
    }


def _effect(sized: Sized, standing: Standing) -> dict[str, Any]:
    concealed, kind = sized.concealed, sized.concealed.kind
    return {
        "effect": kind.effect,
        "location": concealed.location,
        "driver": kind.driver,
        "shape": kind.shape,
        "parameters": [
            {"name": name, "unit": kind.units[name], "value": float(f"{value:.6g}")}
            for name, value in concealed.numbers.items()
        ],
        "strength": round(sized.strength, 3),
        "rms_nm" if kind.lies is None else "rms_rad": float(f"{sized.rms:.5g}"),
        "minor": standing.is_said_by_others,
        "alternatives": [vars(other) for other in standing.alternatives],
    }
