"""Arms worked out by hand: products of D-H matrices and sums over masses, sharing nothing with MuJoCo or pinocchio."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import yaml

ROBOTS = Path(__file__).parents[2] / "config" / "robots"
ARMS = ("parallelogram-120kg", "six-axis", "seven-axis")


def turn(axis: str, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.eye(4)
    if axis == "z":
        matrix[:2, :2] = [[c, -s], [s, c]]
    elif axis == "x":
        matrix[1:3, 1:3] = [[c, -s], [s, c]]
    else:
        matrix[:3:2, :3:2] = [[c, s], [-s, c]]
    return matrix


def shift(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


class HandArm:
    """One arm; `rows` (a m, alpha rad, d m, theta rad) may be changed."""

    def __init__(self, content: dict[str, Any]) -> None:
        self.modified = content["dh"]["convention"] == "modified"
        self.rows = np.array(
            [
                [r["a_mm"] / 1e3, np.radians(r["alpha_deg"]), r["d_mm"] / 1e3, np.radians(r["theta_offset_deg"])]
                for r in content["dh"]["joints"]
            ]
        )
        n = len(self.rows)
        self.actuation = np.eye(n)
        if "actuation" in content:
            self.actuation = np.array([[row.get(f"q{m + 1}", 0) for m in range(n)] for row in content["actuation"]])
        self.tool = np.array(content["tool_mm"]) / 1e3
        self.masses = [link["mass_kg"] for link in content["links"]]
        self.centres = [np.array(link["com_mm"]) / 1e3 for link in content["links"]]
        self.gravity = np.array(content["gravity_m_s2"], dtype=float)

    @classmethod
    def named(cls, name: str) -> HandArm:
        return cls(yaml.safe_load((ROBOTS / f"{name}.yaml").read_text()))

    def frames(self, chain_angles: np.ndarray, rows: np.ndarray | None = None) -> tuple[list, list]:
        """Frame that carries each joint (z is its axis, origin its D-H origin), and each D-H frame."""
        carrying, behind, now = [], [], np.eye(4)
        for (a, alpha, d, theta), angle in zip(self.rows if rows is None else rows, chain_angles, strict=True):
            if self.modified:
                now = now @ turn("x", alpha) @ shift(a, 0, 0) @ shift(0, 0, d)
                carrying.append(now)
                now = now @ turn("z", theta + angle)
            else:
                carrying.append(now)
                now = now @ turn("z", theta + angle) @ shift(0, 0, d) @ shift(a, 0, 0) @ turn("x", alpha)
            behind.append(now)
        return carrying, behind

    def point(self, motors: np.ndarray, rows: np.ndarray | None = None, bent: np.ndarray | float = 0.0) -> np.ndarray:
        """Tool point at motor angles; ``bent`` is added to the chain's angles."""
        _, behind = self.frames(self.actuation @ motors + bent, rows)
        return (behind[-1] @ np.append(self.tool, 1))[:3]

    def loads(self, motors: np.ndarray, payload: float, from_link: int = 0) -> list[tuple[np.ndarray, np.ndarray]]:
        """(place, weight) of every mass from a link (0-based) on, payload at the tool point."""
        _, behind = self.frames(self.actuation @ motors)
        found = [
            ((behind[j] @ np.append(self.centres[j], 1))[:3], self.masses[j] * self.gravity)
            for j in range(from_link, len(self.rows))
        ]
        return [*found, (self.point(motors), payload * self.gravity)]

    def moment(self, motors: np.ndarray, payload: float, about: np.ndarray, from_link: int) -> np.ndarray:
        """Gravity's moment about a point, of everything from a link (0-based) on."""
        return moment_of(self.loads(motors, payload, from_link), about)

    def torques(self, motors: np.ndarray, payload: float) -> np.ndarray:
        """Gravity's torque on the motors, by virtual work."""
        carrying, _ = self.frames(self.actuation @ motors)
        loads = self.loads(motors, payload)
        chain = [moment_of(loads[j:], f[:3, 3]) @ f[:3, 2] for j, f in enumerate(carrying)]
        return self.actuation.T @ np.array(chain)


def moment_of(loads: list[tuple[np.ndarray, np.ndarray]], about: np.ndarray) -> np.ndarray:
    """The moment about a point of weights at their places."""
    return sum(np.cross(place - about, weight) for place, weight in loads)


def spread(centre, weight, start, end, pieces=400):
    """Where a link's weight lies and from where on the beam it hangs: even, and the rest at the nearer end."""
    length = np.linalg.norm(end - start)
    e = (end - start) / length
    along = (centre - start) @ e
    beside = centre - start - along * e
    share = max(1 - abs(2 * along / length - 1), 0.0)
    for piece in range(pieces):
        foot = start + (piece + 0.5) / pieces * (end - start)
        yield foot, (foot + beside, share * weight / pieces)
    if along > length / 2:
        yield end, (end + beside + max(along - length, 0.0) * e, (1 - share) * weight)


def cantilever(loads, start, end):
    """Turn and shift of a beam's end per 1/(E I); a point load at x does e x P x^2/2 and P x^2 (3 L - x)/6."""
    length = np.linalg.norm(end - start)
    e = (end - start) / length
    angle, shift = np.zeros(3), np.zeros(3)
    for foot, weights in loads:
        x = (foot - start) @ e
        force = sum(weight for _, weight in weights)
        moment = moment_of(weights, foot)
        force, moment = force - (force @ e) * e, moment - (moment @ e) * e
        angle += x * moment + x**2 / 2 * np.cross(e, force)
        shift += x * (length - x / 2) * np.cross(moment, e) + x**2 * (3 * length - x) / 6 * force
    return angle, shift
