"""A verdict in one sentence, the same in verdict.json, on the page and on the terminal; and one effect as a clause."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from armscope.core.words import enumerated, uncapitalised
from armscope.physics.clause import Number, Told, say
from armscope.physics.compliance_change import COMPLIANCE_CHANGE
from armscope.physics.elastic import JOINT_COMPLIANCE
from armscope.physics.registry import effect_named
from armscope.verdict.constants import WORDS
from armscope.verdict.diagnosis import Diagnosis, promised
from armscope.verdict.effects import Cause, FoundEffect
from armscope.verdict.family_cures import warms
from armscope.verdict.remainder import above_what, asked_of_noise, still_open
from armscope.verdict.schema import ANOTHER_MODEL, NO_BAD_SHOTS, ROWS_LEFT_OUT, Background, Verdict
from armscope.verdict.told_causes import MOST_OF_ALL, WORST, is_spread, told_and_rest, vague, with_share
from armscope.verdict.untold import beyond_arms, untold
from armscope.verdict.wording import (
    BESIDE,
    GROWS,
    IN_ALL,
    KINDS,
    SMALL,
    SPREAD,
    also_out,
    capitalised,
    main_and_minor,
    millimetres,
    percent,
    plain,
    reach,
    spelled,
)

_OTHERS = "all others a little"


def headline(verdict: Diagnosis) -> str:
    """The answer: one sentence on the causes that count, each with its share of the squared error; one on the rest."""
    main, minor = main_and_minor(verdict.effects)
    if verdict.answer == "cannot tell" and not main:
        return _cannot_tell(verdict)
    if other := another_model(verdict):
        return f"{other} All that follows only describes the difference between the two."
    doubt = unusable(verdict)
    if doubt:
        warning = f"These recordings cannot be relied on; do not act on anything below: {uncapitalised(doubt)}."
        return warning.replace("?.", "?")
    if verdict.answer == "nothing missing":
        rounded = any(notice.kind == "rounded angles" for notice in verdict.notices)
        digits = " (some of it from rounded angles: record more digits)" if rounded else ""
        return (
            f"Nothing is missing: once base and tool are placed, the model matches the recordings to "
            f"{millimetres(verdict.residual_after_mm)} per axis, which is noise{digits}."
        )
    if not main and not verdict.causes:
        return f"{_no_cause(verdict, minor)} {capitalised(_remainder(verdict))}."
    told, rest = told_and_rest(verdict.causes or _one_by_one(verdict))
    clauses = [with_share(c, c is told[0], _share_of_leading(c, verdict.effects)) for c in told]
    first = max(1, sum(c.share > WORDS.told_first for c in told))
    rest_told = [*clauses[first:], *_smaller(rest), *_unsure(verdict), _remainder(verdict)]
    return f"{capitalised('; '.join(clauses[:first]))}. {capitalised('; '.join(rest_told))}."


def cause_in_words(family: str, members: Sequence[FoundEffect], small: Background | None = None) -> str:
    """What is wrong, in a clause: the largest member, where the others are, and whether it is so everywhere.

    Args:
        family: of the cause.
        members: its effects, largest share first; of those that are minor only the places are told.
        small: small errors of the family in the whole arm, where they belong to it; the larger part is told first.

    Returns:
        The clause.
    """
    # what no table of the same rows drawn anew names leads nothing: it is one of the small errors, or no part for sure
    main = [effect for effect in members if not effect.minor]
    told = _leading([e for e in main if not e.never_chosen]) or ([] if small else list((main or members)[:1]))
    none_stands_out = SPREAD.get(family, f"small {family} errors in all joints and links")
    none_stands_out += WORST + small.worst if small and small.worst else ""
    if small and warms(family, small.worst):
        none_stands_out = GROWS.format(small.worst)
    if not told or (small and _is_next_to_nothing(told[0], small)):
        return none_stands_out
    more = _goes_on(told[0], members)
    beside = also_out(family, told[0], [effect for effect in members if effect not in more])
    if small and small.share > sum(effect.share for effect in members) and family in IN_ALL:
        return _with_others(f"{IN_ALL[family]}{MOST_OF_ALL}{phrase(told[0])}", beside)
    if small:
        elsewhere = small.worst and small.worst not in {effect.location for effect in members}
        beside.append(BESIDE.get(family, _OTHERS) + (WORST + small.worst if elsewhere else ""))
    return _with_others(" and ".join([phrase(told[0]), *map(_how, more)]), beside)


def _leading(members: Sequence[FoundEffect]) -> Sequence[FoundEffect]:
    """The one with the largest share; or the first with a sure name, more evidence, and about as much of the error."""
    if not members or members[0].named_as == "effect":
        return members[:1]
    largest = members[0]
    near = [e for e in members if e.share > WORDS.about_as_much * largest.share]
    sure = [e for e in near if e.named_as == "effect" and e.evidence_nats > largest.evidence_nats]
    return sure[:1] or members[:1]


def _share_of_leading(cause: Cause, effects: Sequence[FoundEffect]) -> float:
    """What the member alone is worth (0 ... 1) that a cause's clause begins with; NaN of one that tells no member."""
    members = [effect for effect in effects if effect.as_member in cause.members]
    led = [effect for effect in members if cause.text.startswith(phrase(effect))]
    if not led:
        return math.nan
    return sum(effect.share for effect in [led[0], *_goes_on(led[0], members)])


def _goes_on(told: FoundEffect, members: Sequence[FoundEffect]) -> list[FoundEffect]:
    """Those that the same clause tells, as sure as it is: an eccentric gear may be oval, too."""
    more = COMPLIANCE_CHANGE.name if told.effect == JOINT_COMPLIANCE.name else told.effect
    there = [m for m in members if m is not told and (m.effect, m.location) == (more, told.location)]
    certain = told.named_as == "effect" and bool(_how(told))
    return [m for m in there if certain and _how(m) and m.named_as == "effect" and not (m.minor or m.rarely_chosen)]


def _how(effect: FoundEffect) -> str:
    """ "by ±0.3 mrad twice per turn", "by 3 µrad per N m more from row 90 on"; "" of what neither swings nor gives."""
    said = exact_phrase(effect)
    return said.partition(" swings ")[2] or said.partition(" gives way ")[2]


def _with_others(clause: str, beside: Sequence[str]) -> str:
    """A clause, and in brackets what is beside."""
    return f"{clause} ({', and '.join(beside)})" if beside else clause


def _is_next_to_nothing(effect: FoundEffect, small: Background) -> bool:
    """Whether a member is less than a twentieth of the small errors of its family, in share and (hidden) in size."""
    part, size = effect.share, effect.rms_at_tool_mm
    return part < WORDS.told_first * small.share and size**2 < WORDS.told_first * small.rms_at_tool_mm**2


def unusable(verdict: Diagnosis) -> str:
    """What the check says against the recordings, without its advice; "" for nothing."""
    return next((notice.text.split(". ")[0].rstrip(".") for notice in verdict.notices if notice.kind == "check"), "")


def another_model(verdict: Diagnosis) -> str:
    """That an arm of the library fits clearly better than the stated one, and which; "" for nothing."""
    return next((notice.text for notice in verdict.notices if notice.kind == ANOTHER_MODEL), "")


def more_than_noise(verdict: Verdict) -> bool:
    """Whether what the model leaves is known to be more than noise."""
    return verdict.unexplained.present or any(notice.kind == "model error" for notice in verdict.notices)


def holds(verdict: Verdict) -> bool:
    """Whether rows that took no part in the fit are met better with the model than without, as far as was tested."""
    return not verdict.held_out.after >= verdict.held_out.before  # NaN: not tested


def makes_worse(verdict: Verdict) -> bool:
    """Whether such rows are clearly worse with the model; or worse at all, as the rows are that it was fitted to.

    Rows that fit no name, and those of joints that scatter, count little in a fit: it may miss all rows by more then.
    Where nothing but scatter is told there is nothing that could make them worse.
    """
    if verdict.effects and all(effect.scatters for effect in verdict.effects) and not verdict.background.present:
        return False
    promise, held = promised(verdict), verdict.held_out
    surely = 1 + WORDS.rounding  # where nothing is named the two differ in their last digit
    fits_worse = verdict.residual_after_mm > surely * verdict.residual_before_mm
    worse_at_all = held.after > surely * held.before and held.after_all_rows > surely * held.before_all_rows
    return promise.after > WORDS.clearly_worse * promise.before or (fits_worse and worse_at_all)


def background_in_words(verdict: Verdict) -> str:
    """ "small errors of geometry and stiffness in all its joints and links, as any arm has"."""
    families = [family.family for family in verdict.background_families if family.present] or ["geometric"]
    wander = SMALL["drift"] if "drift" in families else ""
    of_arm = [KINDS.get(family, family) for family in families if family != "drift"]
    if not of_arm:
        return wander
    small = f"small errors of {enumerated(of_arm)} in all joints and links, as any arm has"
    return f"{wander} and {small}" if wander else small


def _no_cause(verdict: Diagnosis, rest: Sequence[FoundEffect]) -> str:
    if verdict.background.present:
        share = percent(verdict.background.share)
        told = background_in_words(verdict)
        verb = "is" if told == SMALL["drift"] else "are"
        return f"No single part stands out: {told}, {verb} {share} of the squared error."
    return f"Only minor causes were found ({spelled(len(rest))})."


def _one_by_one(verdict: Diagnosis) -> list[Cause]:
    """A cause per effect, and one per background, where nobody has gathered them."""
    alone = [
        Cause(e.family, "effect", e.location, (e.title,), False, e.minor, e.share, math.nan, phrase(e), e.cure)
        for e in sorted(verdict.effects, key=lambda effect: -effect.share)
    ]
    small = [
        Cause(b.family, "family", "arm", (), True, False, b.share, math.nan, cause_in_words(b.family, (), b), "")
        for b in verdict.background_families or (verdict.background,)
        if b.present
    ]
    return [*alone, *small]


def _smaller(rest: Sequence[Cause]) -> Iterator[str]:
    """What else the model took in: causes that are counted, and small errors of the whole arm; each with its share."""
    spread = [cause for cause in rest if is_spread(cause)]
    counted = [cause for cause in rest if cause not in spread]
    if counted:
        share, several = sum(cause.share for cause in counted), len(counted) > 1
        told = f"{spelled(len(counted))} smaller cause{'s' if several else ''}"
        later = f"which pay{'' if several else 's'} only once the others are cured"
        yield f"{told} ({percent(share)})" if share > 0 else f"{told}, {later}"
    kinds = [KINDS[cause.family] for cause in spread if cause.family in KINDS]
    share = sum(cause.share for cause in spread)
    of_arm = [f"small errors of {enumerated(kinds)} in the whole arm"] if kinds else []
    told = " and ".join([*of_arm, *(SPREAD["drift"] for cause in spread if cause.family == "drift")])
    if told:
        yield f"{told} ({percent(share)})" if share > 0 else told


def _unsure(verdict: Diagnosis) -> Iterator[str]:
    """Small errors that the model holds though the evidence does not ask for them, and so are in no cause."""
    told = [each for each in verdict.background_families if not each.present and each.share > WORDS.told_though_unsure]
    if told:
        kinds = enumerated([SMALL[each.family] for each in told if each.family in SMALL])
        yield f"possibly {kinds} ({percent(sum(each.share for each in told))})"


def _remainder(verdict: Diagnosis) -> str:
    """What the model leaves, and whether many rows are not met at all."""
    return _left(verdict) + ", and many rows fit none of it" * (
        any(each.kind in (ROWS_LEFT_OUT, NO_BAD_SHOTS) for each in verdict.notices)
    )


def _left(verdict: Diagnosis) -> str:
    """What the model leaves of the rows that it fits."""
    if makes_worse(verdict):
        before, after = millimetres(promised(verdict).before), millimetres(promised(verdict).after)
        return f"but rows that took no part in the fit get worse by it, from {before} to {after}: do not act on it yet"
    if more_than_noise(verdict):
        return still_open(verdict)
    return f"the {millimetres(verdict.residual_after_mm)} that remain are noise"


def phrase(effect: FoundEffect) -> str:
    """One effect as a clause: who does what, by how much."""
    if effect.named_as != "effect":
        return vague(effect)
    return exact_phrase(effect)


def exact_phrase(effect: FoundEffect) -> str:
    """The clause at the level of the single effect, however sure that is."""
    known = effect_named(effect.effect)
    told = say(known.clauses if known else (), _told(effect))
    return f"{told}, far beyond what arms show" if beyond_arms(effect) else told


def atlas_column(effect: FoundEffect) -> str:
    """The column of the atlas in which an effect shows; "" for none."""
    known = effect_named(effect.effect)
    column = known.atlas if known else ""
    return column if isinstance(column, str) else column(_told(effect))


def _told(effect: FoundEffect) -> Told:
    told = () if beyond_arms(effect) else effect.parameters  # a small number beside one that is not told misleads
    numbers = {p.name: Number(p.value, p.unit, p.stderr) for p in told if not untold(p, effect)}
    if effect.curve is not None and len(effect.curve.value):
        farthest = reach(effect.curve)
        numbers[farthest.name] = Number(farthest.value, farthest.unit, farthest.stderr)
    return Told(effect.effect, effect.location, effect.driver, numbers)


def _cannot_tell(verdict: Diagnosis) -> str:
    left, after, above = verdict.unexplained, verdict.residual_after_mm, above_what(verdict.unexplained)
    # larger than all that is left: it is of rows that fit nothing
    if verdict.mismatch and left.description and not (above or WORDS.faint * after <= left.rms_mm <= after):
        return f"Cannot tell what is missing: {plain(left.description)}."
    if verdict.mismatch:
        remain, asked = f"{millimetres(after)} per axis remain, {above or 'more than noise'}", asked_of_noise(verdict)
        end = f": {asked}" if asked else "."
        return f"Cannot tell what is missing: {remain}, but they follow nothing that was recorded{end}"
    why = verdict.notices[-1].text.rstrip(".") if verdict.notices else "the recordings do not say"
    poses = verdict.next_poses
    further = 0 if poses is None or not poses.settle else len(poses.motor_angles)
    settle = f"; {spelled(further)} further poses would settle it" if further else ""
    told = f"Cannot tell: {uncapitalised(why)}{settle}"
    return told if told.endswith("?") else f"{told}."
