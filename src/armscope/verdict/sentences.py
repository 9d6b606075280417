"""A verdict in one sentence, the same in verdict.json, on the page and on the terminal; and one effect as a clause."""

from __future__ import annotations

from armscope.physics.clause import Number, Told, say
from armscope.physics.registry import effect_named
from armscope.verdict.schema import Diagnosis, FoundEffect
from armscope.verdict.wording import (
    capitalised,
    main_and_minor,
    millimetres,
    percent,
    plain,
    reach,
    spelled,
)

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
    known = effect_named(effect.effect)
    return say(known.clauses if known else (), _told(effect))


def atlas_column(effect: FoundEffect) -> str:
    """The column of the atlas in which an effect shows; "" for none."""
    known = effect_named(effect.effect)
    column = known.atlas if known else ""
    return column if isinstance(column, str) else column(_told(effect))


def _told(effect: FoundEffect) -> Told:
    numbers = {p.name: Number(p.value, p.unit, p.stderr) for p in effect.parameters}
    if effect.curve is not None and len(effect.curve.value):
        farthest = reach(effect.curve)
        numbers[farthest.name] = Number(farthest.value, farthest.unit, farthest.stderr)
    return Told(effect.effect, effect.location, effect.driver, numbers)


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
    poses = verdict.next_poses
    settle = "" if poses is None else f"; {spelled(len(poses.motor_angles))} further poses would settle it"
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
