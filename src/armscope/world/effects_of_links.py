"""What is wrong with links and linkages, as concealed worlds build it (conventions: `armscope.world.effects`)."""

from __future__ import annotations

import numpy as np

from armscope.core.types import Array
from armscope.robot.description import RobotDescription
from armscope.world.kinds import (
    ANGLE,
    CONSTANT,
    LOAD,
    TEMPERATURE,
    Kind,
    Parameter,
    Scene,
    Values,
    compliance_for,
    links,
    links_longer_than,
    number,
)
from armscope.world.layout import Geometry
from armscope.world.statics import Hidden
from armscope.world.tolerances import PARALLEL

REFERENCE_C = 20.0


def skewing_tilt(geometry: Geometry, link: int) -> str:
    """The tilt that no number of D-H row ``link`` (0-based) makes: of parallel axes about y; "" where they are not."""
    behind = link if geometry.modified else link + 1
    parallel = abs(np.sin(geometry.rows[link, 1])) < PARALLEL
    return f"tilt {behind + 1} y" if parallel and 0 < behind < geometry.n_joints else ""


def _hide_link_geometry(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    errors = [values.get("a", 0.0), values.get("alpha", 0.0), values.get("d", 0.0), 0.0]
    hidden.misshape(number(location), np.array(errors))
    if "beta" in values:
        hidden.move(skewing_tilt(scene.geometry, number(location)), np.full(len(scene.session), values["beta"]))


def _draw_link_geometry(rng: np.random.Generator, scene: Scene, location: str) -> dict[str, float]:
    """All its numbers, of tolerance proportions: a millimetre goes with a milliradian."""
    skews = bool(skewing_tilt(scene.geometry, number(location)))
    return {name: float(rng.normal(0, 1) * 1e-3) for name in ("alpha", "a", "d", *["beta"] * skews)}


def _hide_thermal(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    link = number(location)
    rows = scene.geometry.rows
    along_a, along_d = scene.geometry.lengthening(link, rows)
    growth = rows[link, 0] * along_a + rows[link, 2] * along_d
    warmer = values["coefficient"] * (scene.session.temperature - REFERENCE_C)
    for axis, amount in zip("xyz", growth, strict=True):
        if amount != 0:
            hidden.move(f"shift {link + 1} {axis}", amount * warmer)


def _hide_linkage(hidden: Hidden, scene: Scene, location: str, values: Values) -> None:
    linkage = scene.description.parallelogram
    assert linkage is not None
    elbow = scene.chain_angles()[:, 2] + scene.geometry.rows[2, 3]
    crank = elbow + np.radians(linkage.crank_angle_deg)
    rocker = close_loop(
        crank,
        linkage.crank_mm * 1e-3,
        linkage.rod_mm * 1e-3 + values["rod"],
        linkage.rocker_mm * 1e-3 + values["rocker"],
        linkage.upper_arm_mm * 1e-3,
    )
    hidden.chain[:, 2] += rocker - crank


def close_loop(crank_angle: Array, crank: float, rod: float, rocker: float, upper_arm: float) -> Array:
    """(N,) angle of the rocker, rad, from the upper arm's direction; crank and rocker point alike, lengths in m.

    Newton's method on |upper arm + rocker - crank| = rod, started from the ideal parallelogram.

    Args:
        crank_angle: (N,) rad, from the upper arm's direction.
        crank, rod, rocker, upper_arm: lengths of the bars, m.

    Returns:
        (N,) rad.

    Raises:
        RuntimeError: bars of these lengths don't meet.
    """
    angle = np.array(crank_angle, dtype=float)
    for _ in range(50):
        gap = upper_arm + rocker * np.exp(1j * angle) - crank * np.exp(1j * crank_angle)
        slope = np.real(np.conj(gap) * 1j * rocker * np.exp(1j * angle)) / np.abs(gap)
        step = (np.abs(gap) - rod) / slope
        angle -= step
        if np.abs(step).max() < 1e-14:
            return angle
    raise RuntimeError("the parallelogram's bars can't be joined")


def _linkages(description: RobotDescription) -> list[str]:
    return ["parallelogram"] if description.parallelogram is not None else []


LINKS: tuple[Kind, ...] = (
    Kind(
        "link_geometry", "", CONSTANT,
        (
            Parameter("alpha", "rad"), Parameter("a", "mm", 1e-3), Parameter("d", "mm", 1e-3),
            Parameter("beta", "rad"),
        ), (),
        links, _draw_link_geometry, _hide_link_geometry,
    ),
    Kind(
        "link_bending", "", LOAD, (Parameter("flexibility", "1/(N m^2)"),), ("payload_kg",), links_longer_than(0.1),
        lambda rng, scene, place: {"flexibility": 2 * compliance_for(scene, float(np.abs(scene.torque).max()))},
        lambda hidden, scene, place, values: hidden.bend(number(place), values["flexibility"]),
    ),
    Kind(
        "thermal_expansion", "", TEMPERATURE, (Parameter("coefficient", "1/K"),), ("temperature_c",),
        links_longer_than(0.1), lambda rng, scene, place: {"coefficient": 2e-5}, _hide_thermal,
    ),
    Kind(
        "parallelogram_geometry", "", ANGLE, (Parameter("rod", "mm", 1e-3), Parameter("rocker", "mm", 1e-3)), (),
        _linkages,
        lambda rng, scene, place: {bar: float(rng.normal(0, 3e-4)) for bar in ("rod", "rocker")}, _hide_linkage,
        arm="parallelogram-120kg",
    ),
)  # fmt: skip
"""In the order of the catalogue."""
