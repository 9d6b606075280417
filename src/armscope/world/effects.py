"""The vocabulary's effects as concealed worlds build them: the contract's conventions, written down once.

Motor angle j is meant by "joint j", except where it says axis. q is the commanded angle, tau the motor's torque from
gravity (virtual work), T the temperature, t the time. Lengths hold at 20 C.

| effect | location | parameters (name, unit) | what is built |
|---|---|---|---|
| base_drift | base | x y z mm/h, rx ry rz rad/h | base slides and hinges move by rate x t, t from the session's zero |
| base_shift | base | x y z mm, rx ry rz rad, time s | base jumps at that time |
| base_compliance | base | compliance rad/(N m) | springs about base x and y |
| joint_offset | joint j | offset rad | angle + offset |
| zero_shift | joint j | jump rad, time s | angle + jump after that time |
| gear_ratio | joint j | ratio rad/rad | angle + ratio q |
| gear_eccentricity | joint j | amplitude rad, phase rad, per_turn 1/turn | + amplitude cos(per_turn q - phase); 1, 2 |
| gear_mesh | joint j | amplitude rad, phase rad, per_turn 1/turn | the same, 5 to 60 |
| backlash | joint j | gap rad | - approach gap/2; variant load: + gap/2 to the side gravity loads |
| joint_compliance | joint j | compliance rad/(N m) | motor spring |
| compliance_change | joint j | give rad/(N m), time s | + give tau after that time |
| compliance_change, temperature | joint j | give_per_k rad/(N m K) | + give_per_k tau (T - 20) |
| bearing_compliance | joint j | compliance rad/(N m) | springs across axis j, two directions, at its D-H origin |
| axis_wobble | joint j | amplitude rad, phase rad, direction rad, per_turn 1/turn | tilt of axis j, see below |
| servo_lag | joint j | delay s | - speed x delay |
| joint_coupling | joint j from joint k | coupling rad/rad | angle j + coupling q_k |
| link_geometry | link j | alpha rad, a mm, d mm, beta rad (some) | D-H row j is that much larger; beta, see below |
| link_bending | link j | flexibility 1/(N m^2) | 1/(E I) of a beam along D-H row j, in segments |
| thermal_expansion | link j | coefficient 1/K | a and d of row j grow by coefficient (T - 20) |
| parallelogram_geometry | parallelogram | rod mm, rocker mm | bars longer, loop closed by Newton's method |
| instrument_scale | instrument | scale m/m | measured = (1 + scale) true |
| payload_error | payload | mass kg; variant centre: com_x com_y com_z mm | added to what is stated |
| holder_sag | tool | sag_x sag_y sag_xy sag_xz sag_yz mm | the target slides on the tool, see below |
| loose_target | tool | play_along mm; variant across: play_across mm | the target falls over in its nest, see below |

axis_wobble tilts axis j, before it turns, by amplitude cos(per_turn theta - phase) about the fixed direction
(cos direction, sin direction, 0) of the frame that carries it; theta is the chain's angle.
holder_sag: by a symmetric matrix of these x the share of a weight that pulls along each axis of the nominal last frame,
against z, whose own entry is zero. loose_target: by play to the lower side, along a direction of that frame or in the
plane across it (nest_x, nest_y, nest_z), where that leans by least_slope at least.
link_geometry: only rows between parallel axes have a beta, the turn about y that follows the row: no other number of it
makes them skew (Hayati and Mirmirani 1985).
link_bending: a beam of length L along e, loaded at its end by the force F and moment M of everything beyond it, turns
there by L/(E I) (M + L/2 e x F) and moves by L^2/(2 E I) M x e + L^3/(3 E I) F, the parts along e left out; bent by
segments, so to 0.4 %. Its own mass lies evenly on the segments, as far as its centre lets it, and the rest at the
nearer end.
Cyclic effects also list `linear`: cosine and sine parts, as in amplitude cos(per_turn q - phase) =
cosine cos(per_turn q) + sine sin(per_turn q); axis_wobble has them about x and about y.
"""

from __future__ import annotations

import numpy as np

from armscope.world.effects_around import BASE, INSTRUMENT_AND_PAYLOAD, TARGET
from armscope.world.effects_of_joints import JOINTS
from armscope.world.effects_of_links import LINKS
from armscope.world.kinds import Concealed, Kind

LIBRARY: tuple[Kind, ...] = (*BASE, *JOINTS, *LINKS, *INSTRUMENT_AND_PAYLOAD, *TARGET)
"""Every effect of the vocabulary that a world can conceal; the frames are off in every world anyway."""


def linear_numbers(effect: Concealed) -> dict[str, float]:
    """Cosine and sine parts, rad, of an effect with a phase; nothing for the others."""
    values = effect.values
    if "phase" not in values:
        return {}
    order = f"{values['per_turn']:.0f}"
    cosine, sine = values["amplitude"] * np.cos(values["phase"]), values["amplitude"] * np.sin(values["phase"])
    if "direction" not in values:
        return {f"cosine_{order}": float(cosine), f"sine_{order}": float(sine)}
    x, y = np.cos(values["direction"]), np.sin(values["direction"])
    return {
        "cosine_rx": float(cosine * x),
        "sine_rx": float(sine * x),
        "cosine_ry": float(cosine * y),
        "sine_ry": float(sine * y),
    }
