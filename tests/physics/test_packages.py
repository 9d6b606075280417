"""An effect of a package is told what it breaks of the contract; one that keeps it is the same effect."""

from collections.abc import Iterator
from dataclasses import replace

import pytest

from armscope.core.inputs import InputError
from armscope.physics.cure import command
from armscope.physics.effect import Driver, DriverKind, Effect, Placed, motor, term
from armscope.physics.packages import held_to_contract
from armscope.recordings import Recordings
from armscope.robot import Arm


def place(arm: Arm, recordings: Recordings) -> Iterator[Placed]:
    yield Placed(PUSH, "joint 1", (term("push", "rad/rad", (motor(1), Driver("beyond", (1,)))),), (1.0,), "its angle")


PUSH = Effect(
    "push", "transmission", place, "A buffer pushes.", "Take it off.", command("Remove it,"),
    clauses=("a buffer pushes {location} by {push}",), drivers={"beyond": DriverKind(lambda scene, j: 0.0)},
)  # fmt: skip


def test_what_keeps_the_contract_is_the_same_effect() -> None:
    held = held_to_contract(PUSH, "mine")
    assert held == PUSH
    assert [placed.name for placed in held.place(None, None)] == ["push"]  # type: ignore[arg-type]


def test_an_instruction_names_what_a_work_order_knows() -> None:
    wrong = replace(PUSH, cure=command("Remove it,", instruction="Remove it at {locaton}."))
    with pytest.raises(InputError, match=r"mine: effect 'push': cure.instruction: found '{locaton}'.*'location'"):
        held_to_contract(wrong, "mine")


def test_a_number_for_all_rows_is_not_one_per_row() -> None:
    held = held_to_contract(PUSH, "mine")
    with pytest.raises(
        InputError, match=r"driver 'beyond': found 'shape \(\)'; one finite number per row, shape \(3,\)"
    ):
        held.drivers["beyond"].values([0, 0, 0], 1)


def test_a_function_that_cannot_even_be_called_is_told_with_its_effects_name() -> None:
    """No line of the package ran, so there is none to point at."""
    wrong = replace(PUSH, place=lambda arm: iter(()))
    with pytest.raises(InputError, match=r"mine: effect 'push': place, .*TypeError"):
        list(held_to_contract(wrong, "mine").place(None, None))  # type: ignore[arg-type]
