"""A mechanism as MuJoCo builds it from its MJCF stands and weighs as the arm worked out by hand."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from armscope.robot.description_file import load_description
from armscope.world.layout import BASE_FREEDOMS, Geometry, Layout, segment_hinges
from armscope.world.mechanism import Mechanism
from armscope.world.mjcf import mjcf
from tests.world.by_hand import ARMS, ROBOTS, HandArm

STEP = 1e-6


def mechanism_of(name: str, **layout: object) -> Mechanism:
    geometry = Geometry(load_description(ROBOTS / f"{name}.yaml"))
    return Mechanism(geometry, Layout(np.zeros_like(geometry.rows), **layout))


@pytest.mark.parametrize("name", ARMS)
def test_the_tool_stands_where_products_of_d_h_matrices_put_it(name: str) -> None:
    hand, mechanism = HandArm.named(name), mechanism_of(name)
    motors = np.linspace(-0.4, 0.5, hand.actuation.shape[1])
    qpos = np.zeros(mechanism.n_freedoms)
    qpos[mechanism.angle_columns()] = hand.actuation @ motors + hand.rows[:, 3]
    mechanism.load(qpos)
    np.testing.assert_allclose(mechanism.tool(), hand.point(motors), atol=1e-9)
    jacobian, tool = mechanism.tool_jacobian(), mechanism.tool()
    for column in mechanism.angle_columns():
        mechanism.set_joints(qpos + STEP * np.eye(len(qpos))[column])
        np.testing.assert_allclose(jacobian[:, column], (mechanism.tool() - tool) / STEP, atol=1e-4)


@pytest.mark.parametrize("name", ARMS)
def test_the_model_holds_all_masses_and_only_the_freedoms_that_were_asked_for(name: str) -> None:
    hand = HandArm.named(name)
    longest = int(np.argmax(np.abs(hand.rows[:, [0, 2]]).sum(axis=1)))
    mechanism = mechanism_of(name, freedoms=frozenset({BASE_FREEDOMS[0], "tilt 2 x"}), flexibility={longest: 1e-9})
    mechanism.set_payload(3.0)
    assert mechanism.model.body_mass.sum() == pytest.approx(sum(hand.masses) + 3.0)
    named = set(mechanism.index) - {f"angle {j + 1}" for j in range(len(hand.rows))}
    assert named == {BASE_FREEDOMS[0], "tilt 2 x", *segment_hinges(longest)}
    text = mjcf(mechanism.geometry, mechanism.layout, mechanism.rows)
    depth = max(path.count("/") for path in _paths(ElementTree.fromstring(text), ""))
    assert depth > 2 * len(hand.rows)  # a chain: every body hangs on the one before


def _paths(node: ElementTree.Element, above: str) -> list[str]:
    here = f"{above}/{node.tag}"
    return [here, *(path for child in node for path in _paths(child, here))]
