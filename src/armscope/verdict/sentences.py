"""A verdict in one sentence, the same in verdict.json, on the page and on the terminal; and one effect as a clause."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from armscope.physics.clause import Number, Told, say
from armscope.physics.registry import effect_named
from armscope.verdict.schema import Diagnosis, FoundEffect, Verdict
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
    """The answer: at most `MOST_TOLD` causes with what each has of the squared error, and one sentence on the rest."""
    main, minor = main_and_minor(verdict.effects)
    if verdict.answer == "cannot tell" and not main:
        return _cannot_tell(verdict)
    doubt = unusable(verdict)
    if doubt:
        return f"These recordings cannot be relied on, and nothing below should be acted on: {_small(doubt)}."
    if verdict.answer == "nothing missing":
        return (
            f"Nothing is missing: once base and tool are placed, the model meets the recordings to "
            f"{millimetres(verdict.residual_after_mm)} per axis, which is noise."
        )
    told, rest = main[:MOST_TOLD], [*main[MOST_TOLD:], *minor]
    if not told:
        return " ".join([_no_cause(verdict, rest), *_remainder(verdict)])
    causes = "; ".join(f"{phrase(effect)} – {percent(effect.share)}{_of_what(n)}" for n, effect in enumerate(told))
    return " ".join([f"{capitalised(causes)}.", *_others(verdict, rest), *_remainder(verdict)])


def unusable(verdict: Diagnosis) -> str:
    """What the check says against the recordings, without its advice; "" for nothing."""
    return next((notice.text.split(". ")[0].rstrip(".") for notice in verdict.notices if notice.kind == "check"), "")


def more_than_noise(verdict: Verdict) -> bool:
    """Whether what the model leaves is known to be more than noise."""
    return verdict.unexplained.present or any(notice.kind == "model error" for notice in verdict.notices)


def background_in_words(verdict: Verdict) -> str:
    """ "small errors of shape and stiffness in all its joints and links, as any arm has"."""
    kinds = {"geometric": "shape", "elastic": "stiffness", "transmission": "drives"}
    families = [family.family for family in verdict.background_families if family.present] or ["geometric"]
    wander = "a slow wander of the set-up" if "drift" in families else ""
    of_arm = [kinds.get(family, family) for family in families if family != "drift"]
    if not of_arm:
        return wander
    *first, last = of_arm
    listed = f"{', '.join(first)} and {last}" if first else last
    small = f"small errors of {listed} in all its joints and links, as any arm has"
    return f"{wander} and {small}" if wander else small


def _no_cause(verdict: Diagnosis, rest: Sequence[FoundEffect]) -> str:
    if verdict.background.present:
        share = percent(verdict.background.share)
        return f"No single part stands out: {background_in_words(verdict)}, account for {share} of the squared error."
    return f"Only minor causes were found ({spelled(len(rest))})."


def _others(verdict: Diagnosis, rest: Sequence[FoundEffect]) -> Iterator[str]:
    """What else the model took in, together."""
    share = sum(effect.share for effect in rest)
    parts = [f"{spelled(len(rest))} smaller cause{'s' if len(rest) > 1 else ''}"] if rest else []
    if verdict.background.present:
        parts.append(background_in_words(verdict))
        share += verdict.background.share
    if parts:
        yield f"{capitalised(', and '.join(parts))}: {percent(share)}."


def _remainder(verdict: Diagnosis) -> Iterator[str]:
    """What the model leaves."""
    left = millimetres(verdict.residual_after_mm)
    if more_than_noise(verdict):
        yield f"The {left} left are more than noise: something is still without a cause."
    else:
        yield f"The {left} left are noise."


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
    return " of the squared error" if position == 0 else ""


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
    return f"Cannot tell: {_small(why)}{settle}."


def _small(text: str) -> str:
    """With a small first letter, unless it begins with a name."""
    return f"{text[:1].lower() if text[1:2].islower() else text[:1]}{text[1:]}"


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
