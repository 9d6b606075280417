"""How a cause of a moving arm is put right, with sign and number where it has one number, or few.

A cure that changes the model adds what the recorded torque has beyond it; one that changes the recording takes it away.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from armscope.motion.library.clauses import ALL_JOINTS, Numbers, amount
from armscope.motion.library.clauses_of_gains import is_turned, other_unit, turned_size
from armscope.recordings.motions import torque_columns
from armscope.robot.dynamics import MovingArm
from armscope.robot.model import dh_halves
from armscope.verdict.effects import Parameter

_SAID = {"mx": "mass × x", "my": "mass × y", "mz": "mass × z"}


@dataclass(frozen=True, eq=False)
class Fitted:
    """What a cure is made of: the cause's words and its numbers."""

    cure: str  # the cause's own sentence
    parameters: tuple[Parameter, ...]  # as fitted
    arm: MovingArm  # as stated
    of_law: tuple[float, ...] = ()  # numbers of the law that it follows; none where it follows none
    place: str = ""  # where it is, as in "link 2" or "joint 3 from joint 2"
    run: str = ""  # the only one that has it; empty where all have
    driver: str = ""  # what it follows
    currents: bool = False  # whether currents were recorded, and not torques

    @property
    def first(self) -> Parameter:
        """Its first number, often its only one."""
        return self.parameters[0]

    @property
    def numbers(self) -> Numbers:
        """All of them by name."""
        return {parameter.name: parameter for parameter in self.parameters}

    @property
    def in_general(self) -> str:
        """The cure without a number, and without its full stop."""
        return self.cure.removesuffix(".")


Remedy = Callable[[Fitted], str]


def add_to_stated(fitted: Fitted) -> str:
    """A number of the model that is the stated one and this."""
    return f"{fitted.in_general}: stated {amount(fitted.first, sign=True)}."


def each_direction(fitted: Fitted) -> str:
    """A coefficient for each direction."""
    forward, backward = ("plus", "less") if fitted.first.value > 0 else ("less", "plus")
    size = amount(fitted.first)
    return f"{fitted.in_general}: the joint's viscous friction {forward} {size} forward, {backward} as much backward."


def by_factor(fitted: Fitted) -> str:
    """A torque constant, and with it the recorded torque; where its sign is turned, that."""
    if is_turned(fitted.first) and fitted.place:
        return turned_back(fitted)
    if fitted.first.value <= -1:
        return fitted.cure
    factor = 1 / (1 + fitted.first.value)
    unit = "" if fitted.currents else other_unit(fitted.first)
    if unit:
        return f"Multiply the recorded torque by {factor:.3f}; was it recorded in {unit}, write it in N m."
    return f"Multiply the joint's torque constant, and so the recorded torque, by {factor:.3f}."


def turned_back(fitted: Fitted) -> str:
    """The column whose sign is turned, and its size where that is off, too."""
    joint = int(fitted.place.split()[1])
    name = torque_columns(fitted.arm.sliding)[joint - 1]
    turn = f"Turn the sign of {name}"
    if fitted.currents:
        name = f"current{joint}_a"
        turn = f"Turn the sign of {name}, or of the joint's gain_nm_per_a in robot.yaml"
    low, high = turned_size(fitted.first).interval
    return f"{turn}." if low <= 0 <= high else f"{turn}, and multiply it by {-1 / (1 + fitted.first.value):.3f}."


def off_the_recording(fitted: Fitted) -> str:
    """An offset of the recorded torque."""
    return f"Take the offset, {amount(fitted.first, sign=True)}, from the recorded torque."


def shifted(fitted: Fitted) -> str:
    """A delay of the recorded torque."""
    side = "earlier" if fitted.first.value > 0 else "later"
    whose = f" of {fitted.place}" if fitted.place == ALL_JOINTS else ""
    return f"Shift the recorded torque{whose} {amount(fitted.first)} {side}, or simulate that."


def lagging(fitted: Fitted) -> str:
    """A link that lags behind its motor."""
    return f"{fitted.in_general}: {amount(fitted.first)} of torque."


def link_shifted(fitted: Fitted) -> str:
    """A link's encoder whose readings are of another time than its motor's."""
    side = "earlier" if fitted.first.value > 0 else "later"
    return f"Shift the link's position {amount(fitted.first)} {side}."


def reduction(fitted: Fitted) -> str:
    """A reduction by which the motor's position was divided."""
    return f"{fitted.in_general}: multiply it by {1 / (1 + fitted.first.value):.6f}."


def behind_its_motor(fitted: Fitted) -> str:
    """A play, at whose end a link lies."""
    return f"{fitted.in_general}: by {amount(fitted.first)}."


def spring_between(fitted: Fitted) -> str:
    """A spring between motor and link."""
    return f"{fitted.in_general}: {amount(fitted.numbers['stiffness'])}."


def per_load(fitted: Fitted) -> str:
    """Friction that grows with the load."""
    return f"{fitted.in_general}: {amount(fitted.first)} × |torque| × sign of the speed."


def as_stated_and(fitted: Fitted) -> str:
    """A load's mass, and its mass times its centre's place."""
    numbers = fitted.numbers
    told = ", ".join(f"{_SAID.get(name, name)} {amount(value, sign=True)}" for name, value in numbers.items())
    where = " in the last joint's frame (z is its axis; of standard D-H rows: before d, a, alpha)"
    where = where if len(numbers) > 1 else ""
    return f"{fitted.in_general}: as stated and {told}{where}."


def with_its_centre(fitted: Fitted) -> str:
    """A link's centre of mass: in the row's frame, as robot.yaml has it, which is not the joint's."""
    numbers = fitted.numbers
    by = np.array([numbers[name].value if name in numbers else 0.0 for name in _SAID])
    dh, links, number = fitted.arm.description.dh, fitted.arm.description.links, int(fitted.place.split()[1]) - 1
    if dh is None or links is None or links[number].mass_kg <= 0:
        told = ", ".join(f"{_SAID[name]} {amount(value, sign=True)}" for name, value in numbers.items())
        return f"{fitted.in_general}, in the joint's frame: as stated and {told}; corrected.urdf has it."
    behind = dh_halves(dh.joints[number], dh.convention)[1]
    moved = np.array(links[number].com_mm) + 1e3 * behind.rotation.T @ by / links[number].mass_kg
    return f"{fitted.in_general}: set its com_mm to [{', '.join(f'{each:.1f}' for each in moved)}]."


def with_its_inertia(fitted: Fitted) -> str:
    """A link's inertia, about its centre of mass: one number on all three axes, or those that the motion tells."""
    if len(fitted.parameters) == 1 and fitted.first.name == "inertia":
        return f"{fitted.in_general}: xx, yy and zz as stated and {amount(fitted.first, sign=True)}, each."
    told = ", ".join(f"{each.name} {amount(each, sign=True)}" for each in fitted.parameters)
    return f"{fitted.in_general}: as stated and {told}, along the joint's axes; corrected.urdf has it."


def as_often_as(fitted: Fitted) -> str:
    """A body of the model that is missing, or there more than once: what is missing is not to be taken out again."""
    low, high = fitted.first.interval
    if high < -0.5:
        return fitted.cure
    if low > 0.5:
        return f"Add it to the model once more: {amount(fitted.first)} times what it weighs comes on top."
    return f"Weigh it and correct its mass: as stated, {amount(fitted.first, sign=True)} times itself."


def gravity_vector(fitted: Fitted) -> str:
    """The direction in which gravity pulls."""
    if not fitted.of_law:
        return fitted.cure
    leans = np.array(fitted.of_law).reshape(-1, 3)
    found = fitted.arm.model.gravity.linear + np.array([each.value for each in fitted.parameters]) @ leans
    return f"Set gravity_m_s2 to [{', '.join(f'{each:.3f}' for each in found)}], or level the base."
