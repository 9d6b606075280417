"""Sizes that rough arms in motion are drawn from (`armscope.world.motion.rough`), all of them assumptions."""

from __future__ import annotations

from dataclasses import dataclass

from armscope.core.constants import Constants


@dataclass(frozen=True)
class RoughMotion(Constants):
    """How rough arms in motion are. A pair is drawn between evenly on a logarithmic scale."""

    mass_share: tuple[float, float] = (0.01, 0.1)
    """one sigma by which links' masses are off; judgement: drawings lack cables, grease and covers"""
    centre_m: tuple[float, float] = (1e-3, 1e-2)
    """one sigma of a link's centre, along each axis [m]; judgement: a motor's own place in its housing"""
    inertia_share: tuple[float, float] = (0.03, 0.3)
    """one sigma by which links' inertias are off; judgement: makers' models take links for solid bodies"""
    rest_share: tuple[float, float] = (0.05, 0.5)
    """of dry friction that comes on top near rest; judgement: greased gears at room temperature (Stribeck's curve)"""
    rest_speed: tuple[float, float] = (0.03, 0.3)
    """speed at which that has faded [rad/s]; judgement: as for stribeck_friction"""
    side_share: tuple[float, float] = (0.01, 0.1)
    """of dry and of viscous friction by which the two directions differ; judgement: gears are cut for one direction of
    load"""
    bend_power: tuple[float, float] = (0.55, 0.95)
    """power of the speed with which viscous friction grows; convention: grease thins as it is sheared"""
    load_share: tuple[float, float] = (0.005, 0.05)
    """dry friction per torque that the gear carries; convention: gears are 95 to 99.5 % efficient beside what they rub
    unloaded"""
    warm_share: tuple[float, float] = (0.05, 0.3)
    """of viscous friction that is gone once gears are warm; convention: grease thins as it warms"""
    ripple_of_noise: tuple[float, float] = (0.1, 0.7)
    """amplitude of a gear's line, over the noise; judgement: it is heard before it is seen"""
    ripple_waves: tuple[float, float] = (2.0, 200.0)
    """waves per turn of that line; derived: of the gear's slow side, and two per turn of its fast one"""
    cable_of_noise: tuple[float, float] = (0.1, 1.0)
    """RMS of what a harness pulls, over the noise; judgement: hoses are laid so that they hardly pull"""
    gain_share: tuple[float, float] = (2e-3, 3e-2)
    """one sigma by which torque is read too large; judgement: magnets and strain gauges spread by some percent"""
    late_s: tuple[float, float] = (2e-4, 2e-3)
    """by which all torque is read late [s]; judgement: a filter, a cycle of the bus"""
    drift_of_noise: tuple[float, float] = (0.1, 0.6)
    """RMS of a zero's wander, over the noise; judgement: strain gauges warm up"""
    drift_s: float = 20.0
    """in which a zero wanders half a wave [s]; judgement: as fast as gears warm up here"""
    pace: tuple[float, float] = (0.3, 1.0)
    """of a run, over that of the fastest; judgement: a programmer's slider"""
    noise_freedom: int = 4
    """degrees of freedom of the noise's t; judgement: between bad readings and none"""
    noise_moving: float = 1.0
    """by which noise is larger at a joint's usual speed than at rest, times what it is at rest; judgement: what a drive
    commutes and a gear grinds is silent at rest"""


ROUGH_MOTION = RoughMotion()
