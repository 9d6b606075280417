"""The library in words: what may make an arm's torques differ from those of its model."""

from __future__ import annotations

from armscope.motion.library import clauses, clauses_of_stands, remedies, remedies_of_curves, remedies_of_laws
from armscope.motion.library.causes import Cause
from armscope.motion.library.changes_catalogue import CHANGES
from armscope.motion.library.clauses_of_gains import gain_clause
from armscope.motion.library.remedies_of_loads import as_tool_load
from armscope.motion.library.twist_catalogue import TWISTS
from armscope.verdict.effects import UNKNOWN

FRICTION, DRIVE, MASSES, SPRINGS = "friction", "drive", "masses", "springs"

_MOMENTS = {f"m{axis}": f"mass × {axis}, in the joint's frame" for axis in "xyz"}

COULOMB = Cause(
    "coulomb_friction",
    FRICTION,
    "Dry friction is not as stated.",
    "Drive the joint slowly to and fro: half the difference of the torques is its dry friction.",
    "Correct `coulomb_nm` of the drive.",
    in_bodies=True,
    clause=clauses.than_stated("dry friction of {} is", "more", "less"),
    remedy=remedies.add_to_stated,
)
VISCOUS = Cause(
    "viscous_friction",
    FRICTION,
    "Viscous friction is not as stated.",
    "Drive the joint at several constant speeds.",
    "Correct `viscous_nm_s_rad` of the drive.",
    in_bodies=True,
    clause=clauses.than_stated("viscous friction of {} is", "more", "less"),
    remedy=remedies.add_to_stated,
)
ROTOR = Cause(
    "rotor_inertia",
    MASSES,
    "The rotor's inertia, seen through the gear, is not as stated.",
    "Accelerate the joint alone in two poses of the rest of the arm.",
    "Correct `rotor_inertia_kg_m2` of the drive.",
    in_bodies=True,
    clause=clauses.than_stated("the rotor inertia of {} is", "more", "less"),
    remedy=remedies.add_to_stated,
)
OFFSET = Cause(
    "torque_offset",
    DRIVE,
    "The recorded torque is off by a constant, or dry friction differs by the direction of motion: while a joint moves "
    "these are the same torque. So is a sensor's dead zone where torque keeps its sign.",
    "Turn the joint slowly either way: the mean of the two torques, less gravity's, is the offset. What is still read "
    "with the drive off is the sensor's, the rest is friction's.",
    "Subtract the offset from the recorded torque.",
    clause=clauses.offset_clause,
    remedy=remedies.off_the_recording,
)
ASYMMETRY = Cause(
    "asymmetric_friction",
    FRICTION,
    "Viscous friction differs by the direction of motion.",
    "Drive the joint to and fro at several constant speeds and compare the torques of both directions.",
    "Give the friction model one viscous coefficient for each direction.",
    labels={"viscous_difference": "forward, beyond the mean"},
    clause=clauses.asymmetric_clause,
    remedy=remedies.each_direction,
)
STRIBECK = Cause(
    "stribeck_friction",
    FRICTION,
    "Friction falls from its value near rest as lubrication sets in.",
    "Drive the joint at many constant slow speeds, either way.",
    "Add a Stribeck term exp(-(speed/width)^2) to the friction model.",
    clause=clauses.stribeck_clause,
    remedy=remedies_of_laws.near_rest,
)
LOAD_FRICTION = Cause(
    "load_friction",
    FRICTION,
    "Dry friction grows with the torque that the gear carries.",
    "Repeat one motion with and without a payload: friction must grow with the load.",
    "Let dry friction in the model grow with the absolute torque that rigid bodies ask of the joint.",
    nonnegative=True,
    labels={"per_load": "friction per torque"},
    clause=clauses.grows_clause,
    remedy=remedies.per_load,
)
VISCOUS_CURVE = Cause(
    "viscous_curve",
    FRICTION,
    "Friction grows with another power of the speed than the first.",
    "Drive the joint at constant speeds up to its fastest.",
    "Use a curve of friction over speed instead of one coefficient.",
    clause=clauses.power_clause,
    remedy=remedies_of_laws.curve_of_speed,
)
TEMPERATURE_FRICTION = Cause(
    "thermal_friction",
    FRICTION,
    "Friction changes as the gear warms up: with the temperature, or where none is recorded while the arm runs.",
    "Repeat one motion cold and warm.",
    "Let friction follow the temperature.",
    clause=clauses.warming_clause,
    remedy=remedies_of_laws.with_warmth,
    each_form=True,  # grease thins, and a seal's dry friction falls as well
)
COUPLED_FRICTION = Cause(
    "coupled_friction",
    FRICTION,
    "Something between two joints rubs with the sum or difference of their speeds.",
    "Move one of the joints alone and watch the other one's torque.",
    "Let the friction of both joints follow the sum or difference of their speeds, too.",
    clause=clauses.between_joints("something rubs between {}"),
    remedy=remedies_of_laws.rubbing,
)
COUPLED_INERTIA = Cause(
    "coupled_inertia",
    MASSES,
    "Something turns with the sum or difference of two joints' motions and has inertia of its own.",
    "Accelerate one of the joints alone and watch the other one's torque.",
    "State how the two joints' motors are coupled (`actuation`), with their rotor inertias.",
    nonnegative=True,
    clause=clauses.between_joints("something heavy turns between {}"),
    remedy=remedies_of_laws.turning_along,
)
GAIN = Cause(
    "motor_constant",
    DRIVE,
    "The motor gives another torque than its stated constant says: all of the joint's torque is off by one factor.",
    "Hang a known mass on the arm: torque must change by its weight times its lever.",
    "Correct the joint's torque constant.",
    labels={"gain": "recorded / true torque − 1"},
    clause=gain_clause,
    remedy=remedies.by_factor,
)
DELAY = Cause(
    "torque_delay",
    DRIVE,
    "Torque was recorded at another time than the motion that it belongs to: behind a filter it is late, and a command "
    "that a drive holds until the next one is early by half of that time.",
    "Shift the recorded torque against the motion and watch the difference.",
    "Shift the torque back by the delay, or simulate the delay.",
    clause=clauses.delay_clause,
    remedy=remedies.shifted,
    confirm_common="See whether torque and position come with one time stamp, by one bus, and which filter torques "
    "pass. Shift the recorded torque of all joints against the motion and watch the difference.",
    open_clause=clauses.open_delay_clause,
    open_cure="Change nothing for it yet. Turn the joint to and fro at two speeds: friction that clings comes back "
    "over the same angle, a delay after the same time.",
)
BALANCER = Cause(
    "gravity_balance",
    SPRINGS,
    "A spring, a gas spring or a counterweight pulls the joint toward one position, or away from it.",
    "Hold the joint still at several positions and compare its torque with gravity's.",
    "Add the spring's or counterweight's torque to the model.",
    labels={"force_lever": "force × shorter lever", "growth": "growth of it over the longer lever"}
    | {"phase": "between both ends at zero", "ratio": "shorter / longer lever"},
    clause=clauses.balance_clause,
    remedy=remedies_of_laws.spring,
)
RIPPLE = Cause(
    "torque_ripple",
    DRIVE,
    "Gear or motor give torque that repeats several times per turn.",
    "Turn the joint slowly at constant speed and look at the torque over its angle.",
    "Add the waves to the model.",
    clause=clauses.ripple_clause,
    remedy=remedies_of_laws.waves,
)
CABLE = Cause(
    "cable_torque",
    SPRINGS,
    "Cables or hoses pull with a torque that follows the joint's position.",
    "Turn the joint slowly either way with the cables unplugged and plugged.",
    "Add the curve to the model, or lay the cables otherwise.",
    clause=clauses.at_place("cables or hoses pull at {}"),
    remedy=remedies_of_curves.by_its_points,
)
AT_ITS_CENTRE = "at its centre"
"""Form of a link's mass that is off while its inertia about its centre of mass is as stated."""
LINK_MASS = Cause(
    "link_mass",
    MASSES,
    "A link is heavier or lighter than stated, with its centre of mass where it is stated.",
    "Weigh the link, or hold the arm still with it level.",
    "Correct the link's mass, and its inertia in proportion.",
    in_bodies=True,
    clause=clauses.than_stated("{} is", "heavier", "lighter"),
    remedy=remedies.add_to_stated,
    cures={AT_ITS_CENTRE: "Correct the link's mass alone, its inertia about its centre of mass is as stated."},
)
LINK_CENTRE = Cause(
    "link_first_moment",
    MASSES,
    "A link's centre of mass lies elsewhere than stated.",
    "Hold the arm still in many poses.",
    "Correct the link's centre of mass.",
    in_bodies=True,
    labels=_MOMENTS,
    clause=clauses.moment_clause,
    remedy=remedies.with_its_centre,
)
LINK_INERTIA = Cause(
    "link_inertia",
    MASSES,
    "A link's inertia differs from the stated one.",
    "Repeat one motion at several accelerations.",
    "Correct the link's inertia.",
    in_bodies=True,
    clause=clauses.at_place("the inertia of {} is not as stated"),
    remedy=remedies.with_its_inertia,
)
PAYLOAD = Cause(
    "payload_error",
    MASSES,
    "The arm carries more or less at its last link than stated, or carries it elsewhere.",
    "Weigh what is mounted on the flange; run the same motion with nothing mounted.",
    "State the mass and centre of mass of what is mounted.",
    in_bodies=True,
    labels=_MOMENTS,
    clause=clauses.payload_clause,
    remedy=as_tool_load,
)
BODY = Cause(
    "attached_body",
    MASSES,
    "A body of the model is not on the arm, or is there more than once.",
    "Look whether it is mounted.",
    "Take the body out of the model, or mount it.",
    in_bodies=True,
    labels={"times": "times what it weighs"},
    clause=clauses.body_clause,
    remedy=remedies.as_often_as,
)
GRAVITY = Cause(
    "gravity_direction",
    MASSES,
    "Gravity pulls in another direction than stated: the base is tilted.",
    "Put a level on the base.",
    "Correct `gravity_m_s2`.",
    labels={"x": "about x of the base", "y": "about y of the base"},
    clause=clauses.tilt_clause,
    remedy=remedies.gravity_vector,
)
ROCKING_BASE = Cause(
    "rocking_base",
    SPRINGS,
    "What the arm stands on gives way under the arm's own moment, and rings.",
    "Put an accelerometer on the base and stop the arm short: it rings at the frequency that is told.",
    "Stiffen the stand or its anchors, or move more smoothly.",
    labels={"about_x": "turn about x of the base", "about_y": "turn about y"}
    | {"about_both": "turn about each, by the moment about the other"},
    clause=clauses_of_stands.rocking_clause,
)
COMPLIANCE = Cause(
    "joint_compliance",
    SPRINGS,
    "Belt, gear or shaft give way under the link's torque, behind the motor's encoder.",
    "Block the link and let the motor push against it: its encoder still turns, in proportion to the torque.",
    "Let the link of the model lag behind its motor.",
    nonnegative=True,
    clause=clauses.compliance_clause,
    remedy=remedies.lagging,
)
WAY, PLAY, SCALE = remedies_of_curves.WAY, remedies_of_curves.PLAY, clauses.SCALE
"""What laws follow that no cause has: hysteresis of friction, play between motor and sensor, a sensor that bends."""
UNEVEN = remedies_of_curves.UNEVEN
"""What dry friction follows that is not the same all around: of a gear off its centre."""
CURVE = Cause(
    "unknown",
    UNKNOWN,
    "Torque follows something in a way that no cause of the library has.",
    "Look at its curve, and repeat the motion with only that joint moving.",
    "Use the curve in the prediction.",
    clause=clauses.nameless_clause,
    remedy=remedies_of_curves.by_its_points,
)
BACKGROUND = (OFFSET, COULOMB, VISCOUS, ROTOR)
"""What every joint has, one column each: free where robot.yaml does not state it; an offset is always a cause."""
CAUSES = (
    COULOMB, VISCOUS, ROTOR, OFFSET, ASYMMETRY, STRIBECK, LOAD_FRICTION, VISCOUS_CURVE, TEMPERATURE_FRICTION,
    COUPLED_FRICTION, COUPLED_INERTIA, GAIN,
    DELAY, COMPLIANCE, BALANCER, RIPPLE, CABLE, LINK_MASS, LINK_CENTRE, LINK_INERTIA, PAYLOAD, BODY,
    GRAVITY, ROCKING_BASE, *CHANGES, CURVE,
)  # fmt: skip


def cause_named(name: str) -> Cause | None:
    """A cause by its name, of torque or of a link's place; None where the library has none of that name."""
    return next((cause for cause in (*CAUSES, *TWISTS) if cause.name == name), None)
