"""The first sentence of a report, in plain words: what gives, by how much, and what share of the mismatch that is."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from armscope.report.text.wording import (
    capitalised,
    main_and_minor,
    millimetres,
    number_of,
    percent,
    plain,
    reach,
    rounded,
    spelled,
)
from armscope.verdict.schema import Diagnosis, FoundEffect, Parameter

MOST_TOLD = 3
"""More effects than this are counted, not told."""

FAINT = 0.7
"""Something unexplained that is smaller than this share of the residual is hidden in the noise."""


def headline(verdict: Diagnosis) -> str:
    """The answer in one sentence."""
    main, minor = main_and_minor(verdict.effects)
    if verdict.answer == "nothing missing":
        return (
            f"Nothing is missing: once base and tool are placed, the model meets the recordings to "
            f"{millimetres(verdict.residual_after_mm)} per axis, which is noise."
        )
    if verdict.answer == "cannot tell" and not main:
        return _cannot_tell(verdict)
    parts = [f"{phrase(effect)} – {percent(effect.share)}{_of_what(n)}" for n, effect in enumerate(main[:MOST_TOLD])]
    if verdict.background.present:
        share = f"{percent(verdict.background.share)}{_of_what(len(parts))}"
        parts.append(f"{'' if parts else 'only '}{background_in_words(verdict)} – {share}")
    if len(main) > MOST_TOLD:
        rest = main[MOST_TOLD:]
        parts.append(f"and {spelled(len(rest))} more effect{'s' if len(rest) > 1 else ''}")
    if not parts:
        parts = [f"only minor effects were found ({spelled(len(minor))})"]
    return capitalised("; ".join(parts)) + "."


def background_in_words(verdict: Diagnosis) -> str:
    """ "small geometric and elastic errors everywhere in the arm"."""
    families = [family.family for family in verdict.background_families if family.present] or ["geometric"]
    *first, last = families
    listed = f"{', '.join(first)} and {last}" if first else last
    return f"small {listed} errors everywhere in the arm"


def phrase(effect: FoundEffect) -> str:
    """One effect as a clause: who does what, by how much."""
    if effect.named_as != "effect":
        return _vague(effect)
    return exact_phrase(effect)


def exact_phrase(effect: FoundEffect) -> str:
    """The clause at the level of the single effect, however sure that is."""
    needed, clause, without = _CLAUSES.get(effect.effect, ("", None, GENERAL))
    parameters = {p.name: p for p in effect.parameters}
    if clause is None or needed not in {"", *parameters}:
        return without.format(effect=plain(effect.effect), location=_joint(effect.location))
    return clause(effect, parameters)


def _of_what(position: int) -> str:
    return " of the mismatch" if position == 0 else ""


def _cannot_tell(verdict: Diagnosis) -> str:
    left, after = verdict.unexplained, verdict.residual_after_mm
    # larger than all that is left: it is of rows that fit nothing
    if verdict.mismatch and left.description and not FAINT * after <= left.rms_mm <= after:
        return f"Cannot tell what is missing: {plain(left.description)}."
    if verdict.mismatch:
        remains = millimetres(after)
        return (
            f"Cannot tell what is missing: {remains} per axis remain, more than the noise, "
            "but they follow nothing that was recorded."
        )
    why = verdict.notices[-1].text.rstrip(".") if verdict.notices else "the recordings do not say"
    settle = "; the measurements named below would settle it" if verdict.next_poses is not None else ""
    return f"Cannot tell: {why[:1].lower() if why[1:2].islower() else why[:1]}{why[1:]}{settle}."


def _vague(effect: FoundEffect) -> str:
    """A region or a family, with the best single reading in brackets."""
    if " or " in effect.title:
        return f"either {plain(effect.title)}"
    kinds = {
        "elastic": "something gives way under load",
        "geometric": "something has another shape than stated",
        "transmission": "a drive turns otherwise than commanded",
        "thermal": "something grows with temperature",
        "drift": "something moves during the recording",
        "unknown": "something follows no known physics",
    }
    _, _, where = effect.title.partition(", ")
    what = kinds.get(effect.family, f"something {effect.family}")
    return f"{what} {where or 'in the arm'} (best single reading: {exact_phrase(effect)})"


Parameters = Mapping[str, Parameter]
Clause = Callable[[FoundEffect, Parameters], str]


def _with(before: str, name: str, after: str = "", sign: bool = False) -> Clause:
    """``before`` + the parameter's size in the field's units + ``after``; {location} is filled in."""

    def clause(effect: FoundEffect, parameters: Parameters) -> str:
        text = f"{before}{number_of(parameters[name], sign)}{after}"
        return text.format(location=effect.location)

    return clause


def _joint(location: str) -> str:
    """The joint itself, without where it takes it from."""
    return location.split(" from ")[0]


def _ratio(effect: FoundEffect, parameters: Parameters) -> str:
    ratio = parameters["ratio"].value
    return f"{effect.location} turns {rounded(100 * abs(ratio))} % too {'far' if ratio > 0 else 'little'}"


def _waves(effect: FoundEffect, parameters: Parameters) -> str:
    count = parameters["per_turn"].value if "per_turn" in parameters else 1
    often = {1: "once per turn", 2: "twice per turn"}.get(round(count), f"{count:.0f} times per turn")
    what = "the axis of {location} tilts" if effect.effect == "axis_wobble" else "the angle of {location} swings"
    size = number_of(parameters["amplitude"])
    return f"{what} by ±{size} {often}".format(location=effect.location)


def _coupling(effect: FoundEffect, parameters: Parameters) -> str:
    joint, _, other = effect.location.partition(" from ")
    return f"{joint} turns by {number_of(parameters['coupling'])} of {other or 'another joint'}"


def _geometry(effect: FoundEffect, parameters: Parameters) -> str:
    """The parameter that stands out most from its uncertainty, and the next."""
    lengths = {"a": "length a", "d": "length d", "alpha": "twist α", "theta": "turn θ", "beta": "twist β"}
    if not parameters:
        return f"{effect.location} differs from its drawing"
    told = sorted(parameters.values(), key=lambda p: -abs(p.value) / (p.stderr or math.inf))[:2]
    clear = [p for p in told if p.stderr and abs(p.value) > 3 * p.stderr] or told[:1]
    errors = " and ".join(f"{lengths.get(p.name, p.name)} by {number_of(p, sign=True)}" for p in clear)
    return f"{effect.location} differs from its drawing: {errors}"


def _expansion(effect: FoundEffect, parameters: Parameters) -> str:
    return f"{effect.location} grows by {number_of(parameters['coefficient'])} with temperature"


def _rod(effect: FoundEffect, parameters: Parameters) -> str:
    bars = " and ".join(f"{p.name} by {number_of(p, sign=True)}" for p in parameters.values())
    return f"the parallelogram's bars differ: {bars}"


def _scale(effect: FoundEffect, parameters: Parameters) -> str:
    scale = parameters["scale"]
    return f"the instrument measures {number_of(scale)} too {'long' if scale.value > 0 else 'short'}"


def _jump(effect: FoundEffect, parameters: Parameters) -> str:
    size = math.sqrt(sum(parameters[axis].value ** 2 for axis in "xyz" if axis in parameters))
    when = f" at {parameters['time'].value:.0f} s" if "time" in parameters else ""
    when = f" at row {parameters['row'].value:.0f}" if "row" in parameters else when
    return f"the {effect.location} jumped by {rounded(size)} mm{when}"


def _drift(effect: FoundEffect, parameters: Parameters) -> str:
    size = math.sqrt(sum(parameters[axis].value ** 2 for axis in "xyz" if axis in parameters))
    in_rows = any("rows" in parameter.unit for parameter in parameters.values())
    _, comma, paused = effect.driver.partition(", ")
    return f"the base drifts by {rounded(size)} mm per {'1000 rows' if in_rows else 'hour'}{comma}{paused}"


def _payload(effect: FoundEffect, parameters: Parameters) -> str:
    if not parameters:
        return "the payload is not as stated"
    told = " and ".join(f"{plain(p.name)} by {number_of(p, sign=True)}" for p in parameters.values())
    return f"the payload is not as stated: {told}"


def _unknown(effect: FoundEffect, parameters: Parameters) -> str:
    if "scatter" in parameters:
        size = number_of(parameters["scatter"])
        return f"{effect.location} scatters by {size} for a reason that the table does not record"
    size = ""
    if effect.curve is not None and len(effect.curve.value):
        size = f", by up to {number_of(reach(effect.curve))}"
    return f"something unexplained at {effect.location} follows the {effect.driver}{size}"


GENERAL = "{effect} at {location}"
_CLAUSES: dict[str, tuple[str, Clause | None, str]] = {
    # effect: (the parameter that the clause needs, the clause, what is said without it)
    "joint_compliance": (
        "compliance",
        _with("{location} gives way by ", "compliance", " under gravity"),
        "{location} gives way under gravity",
    ),
    "bearing_compliance": (
        "compliance",
        _with("the bearing of {location} tilts by ", "compliance", " under gravity"),
        "the bearing of {location} tilts under gravity",
    ),
    "base_compliance": (
        "compliance",
        _with("the base tilts by ", "compliance", " under the arm's moment"),
        "the base tilts under the arm's moment",
    ),
    "link_bending": ("", None, "{location} bends under its load"),
    "joint_offset": ("offset", _with("the zero of {location} is off by ", "offset", sign=True), GENERAL),
    "gear_ratio": ("ratio", _ratio, GENERAL),
    "gear_eccentricity": ("amplitude", _waves, GENERAL),
    "gear_mesh": ("amplitude", _waves, GENERAL),
    "axis_wobble": ("amplitude", _waves, GENERAL),
    "backlash": ("gap", _with("{location} has ", "gap", " of play"), "{location} has play"),
    "servo_lag": ("delay", _with("{location} runs behind by ", "delay"), GENERAL),
    "joint_coupling": ("coupling", _coupling, GENERAL),
    "link_geometry": ("", _geometry, GENERAL),
    "thermal_expansion": ("coefficient", _expansion, GENERAL),
    "parallelogram_geometry": ("rod", _rod, GENERAL),
    "instrument_scale": ("scale", _scale, GENERAL),
    "base_shift": ("x", _jump, "the {location} jumped"),
    "tool_shift": ("x", _jump, "the {location} jumped"),
    "base_drift": ("x", _drift, "the base drifts"),
    "payload_error": ("", _payload, GENERAL),
    "unknown": ("", _unknown, GENERAL),
}
