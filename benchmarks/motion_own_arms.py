"""Arms of three to six joints and their motions, by Newton-Euler in plain NumPy: nothing of the package makes them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FINE_HZ, SECONDS = 2000, 16.0
DOWN, G = np.array([0.0, 0.0, -1.0]), 9.81
ROWS = {  # a, alpha, d of standard D-H rows: m, deg, m
    3: ((0, -90, 0.4), (0.45, 0, 0), (0.35, 0, 0)),
    4: ((0.05, -90, 0.35), (0.5, 0, 0), (0.06, -90, 0), (0, 0, 0.45)),
    5: ((0.05, -90, 0.4), (0.5, 0, 0), (0.4, 0, 0), (0, -90, 0.1), (0, 0, 0.12)),
    6: ((0.1, -90, 0.45), (0.6, 0, 0), (0.1, -90, 0), (0, 90, 0.6), (0, -90, 0), (0, 0, 0.12)),
}
MIDDLE, SWING = np.array([0, -0.9, 0.6, 0, 0.5, 0]), np.array([1.3, 0.6, 0.7, 0.9, 0.9, 1.2])
Body = tuple[float, np.ndarray, np.ndarray]
"""Mass, centre, inertia about it, in its D-H frame."""


@dataclass(frozen=True, eq=False)
class Arm:
    """Rows, bodies and (n,) dry and viscous friction and rotors of an arm."""

    rows: tuple[tuple[float, float, float], ...]
    bodies: tuple[Body, ...]
    dry: np.ndarray
    viscous: np.ndarray
    rotor: np.ndarray

    def torques(self, motion: tuple[np.ndarray, ...], down: np.ndarray = DOWN) -> np.ndarray:
        """(N, n) that the bodies ask of the joints on positions, velocities and accelerations (N, n)."""
        q, dq, ddq = motion
        z, turned, forces = np.array([0, 0, 1.0]), [], []
        speed, bend, push = np.zeros((len(q), 3)), np.zeros((len(q), 3)), np.tile(-G * down, (len(q), 1))
        for j, (row, (mass, centre, inertia)) in enumerate(zip(self.rows, self.bodies, strict=True)):
            R, p = _transform(row, q[:, j])
            back = lambda v, R=R: np.einsum("nij,ni->nj", R, v)
            turn = dq[:, j, None] * z
            bend = back(bend + ddq[:, j, None] * z + np.cross(speed, turn))
            speed, r = back(speed + turn), back(p)
            moved = lambda at, w=speed, b=bend: np.cross(b, at) + np.cross(w, np.cross(w, at))
            push = back(push) + moved(r)
            force = mass * (push + moved(np.broadcast_to(centre, r.shape)))
            forces.append((force, bend @ inertia.T + np.cross(speed, speed @ inertia.T), r, centre))
            turned.append(R)
        found, force, moment = np.zeros(q.shape), np.zeros((len(q), 3)), np.zeros((len(q), 3))
        for j in reversed(range(len(self.rows))):
            own, turning, r, centre = forces[j]
            moment = moment + turning + np.cross(r + centre, own) + np.cross(r, force)
            force = force + own
            force, moment = (np.einsum("nij,nj->ni", turned[j], each) for each in (force, moment))
            found[:, j] = moment[:, 2]
        return found

    def friction(self, motion: tuple[np.ndarray, ...]) -> np.ndarray:
        """(N, n) of friction and rotors; at rest dry friction stays at a share of what it was."""
        _, dq, ddq = motion
        rest = np.abs(dq) < 2e-5
        last = np.maximum.accumulate(np.where(~rest, np.arange(len(dq))[:, None], 0), axis=0)
        side = np.where(rest, 0.6 * np.take_along_axis(np.sign(dq), last, 0), np.tanh(dq / 1e-3))
        return self.dry * side + self.viscous * dq + self.rotor * ddq

    def robot(self, stated: bool) -> dict:
        """robot.yaml."""
        at = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
        names = ("rotor_inertia_kg_m2", "coulomb_nm", "viscous_nm_s_rad")
        joints = [{"a_mm": 1e3 * a, "alpha_deg": alpha, "d_mm": 1e3 * d} for a, alpha, d in self.rows]
        links = [
            {"mass_kg": m, "com_mm": (1e3 * c).tolist(), "inertia_kg_m2": [float(inertia[k]) for k in at]}
            for m, c, inertia in self.bodies
        ]
        of_drives = np.column_stack([self.rotor, self.dry, self.viscous]).tolist()
        drives = [dict(zip(names, each, strict=True)) for each in of_drives]
        content = {"name": f"{len(self.rows)} joints", "dh": {"convention": "standard", "joints": joints}}
        return content | {"links": links, "gravity_m_s2": [0, 0, -G]} | ({"drives": drives} if stated else {})


def _transform(row: tuple[float, float, float], q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3, 3) and (N, 3) from a row's frame to the one before."""
    a, alpha, d = row[0], np.radians(row[1]), row[2]
    c, s, ca, sa, zero = np.cos(q), np.sin(q), np.cos(alpha), np.sin(alpha), np.zeros_like(q)
    R = np.array([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [zero, zero + sa, zero + ca]])
    return np.moveaxis(R, 2, 0), np.column_stack([a * c, a * s, zero + d])


def arm_of(n: int, rng: np.random.Generator) -> Arm:
    """An arm of n joints, its bodies boxes about the middle of its links."""
    bodies = []
    for j, (a, alpha, d) in enumerate(ROWS[n]):
        mass, long = (30, 18, 12, 6, 3, 1.5)[j] * rng.uniform(0.8, 1.2), max(a, d, 0.15)
        along = np.array([0, -d / 2, 0]) if alpha else np.array([0, 0, -d / 2])
        centre = np.array([-a / 2, 0, 0]) + rng.uniform(-0.04, 0.04, 3) + along * (j > 0)
        bodies.append((float(mass), centre, np.diag(mass / 12 * (0.15**2 + 0.8 * long**2) * rng.uniform(0.8, 1.2, 3))))
    dry = np.array([8, 9, 6, 2.5, 1.6, 1.0])[:n] * rng.uniform(0.8, 1.2, n)
    return Arm(ROWS[n], tuple(bodies), dry, dry * rng.uniform(0.8, 1.6, n), dry * rng.uniform(0.05, 0.12, n))


def waves(n: int, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """Positions, velocities and accelerations (T, n): eight waves a joint."""
    t, motion = np.arange(int(SECONDS * FINE_HZ))[:, None] / FINE_HZ, 0.0
    for k in range(1, 9):
        size, omega = SWING[:n] * rng.uniform(0.3, 1, n) / k**0.9, 2 * np.pi * k * rng.uniform(0.06, 0.1)
        phase = omega * t + rng.uniform(0, 2 * np.pi, n)
        motion = motion + size * np.array([np.sin(phase), omega * np.cos(phase), -(omega**2) * np.sin(phase)])
    motion[0] += MIDDLE[:n] + rng.uniform(-0.2, 0.2, n)
    return tuple(motion)


def moves(n: int, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """The same from point to point, by polynomials of the fifth degree with pauses between."""
    pieces, here = [], MIDDLE[:n]
    while sum(len(piece[0]) for piece in pieces) < SECONDS * FINE_HZ:
        there, long = MIDDLE[:n] + rng.uniform(-0.6, 0.6, n) * SWING[:n], rng.uniform(1.2, 2.8)
        s, way = np.arange(0, 1, 1 / (long * FINE_HZ))[:, None], there - here
        shapes = 10 * s**3 - 15 * s**4 + 6 * s**5, 30 * (s - s**2) ** 2, 60 * s - 180 * s**2 + 120 * s**3
        pieces.append(np.array([here + way * shapes[0], way * shapes[1] / long, way * shapes[2] / long**2]))
        rest = np.zeros((3, int(rng.uniform(0, 0.3) * FINE_HZ), n))
        rest[0], here = there, there
        pieces.append(rest)
    return tuple(np.concatenate(pieces, axis=1)[:, : int(SECONDS * FINE_HZ)])
