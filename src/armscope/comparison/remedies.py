"""What to do about a change: find out why, confirm it, and take back what changed, as a work order words it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from armscope.comparison.constants import COMPARING
from armscope.comparison.flange_load import ANOTHER_LOAD
from armscope.comparison.result import Change, Comparison
from armscope.comparison.valued import Valued
from armscope.core.words import enumerated, size_of
from armscope.physics.effect import Effect
from armscope.physics.geometric import JOINT_OFFSET
from armscope.physics.registry import effect_named
from armscope.verdict.corrections import bars_set_right
from armscope.verdict.effects import INTERVAL, Parameter
from armscope.verdict.entries import angle, length
from armscope.verdict.tasks import with_numbers
from armscope.verdict.wording import millimetres, read_parameter


@dataclass(frozen=True)
class Remedy:
    """What to do, in words."""

    physics: str  # what the cause is
    why: str  # where to look for why it changed
    confirm: str  # how to confirm it on the arm
    # instruction, rule: what is done about it, by how much; and what else can be done
    instruction: str
    rule: str


def remedy_of(found: Comparison, change: Change) -> Remedy:
    """What to do about one change; its numbers are those of the change, not of all that is off. Returns the words;
    empty ones of an effect that is not installed any more."""
    known = ANOTHER_LOAD if change.effect == ANOTHER_LOAD.name else effect_named(change.effect)
    if known is None:
        return Remedy("", _why(found, change), "", "", "")
    if found.over_in(change):
        done = f"Nothing is left to be done about what {enumerated(change.where)} alone had."
        return Remedy(known.physics, _why(found, change), "", done, "")
    numbers = [difference_of(number) for number in change.parameters if not number.unknown]
    verb, before, after = "it differs" if found.of_arms else "it moved", "", _worth(change)
    if (turned := _on_the_other_side(found, change)) is not None:
        numbers, verb, after = [turned], "it is off", _all_of_it(change)
    elif known is not ANOTHER_LOAD:  # a load is weighed, not taken back
        if change.is_less or change.is_hidden:
            return Remedy(known.physics, _why(found, change), "", _nothing_to_mend(change), "")
        before = _if_more(found, change) if is_open(change) else ""
    cure = known.cure.instruction.format_map(_words(known, change.location, numbers, verb))
    rule = with_numbers(known.cure.rule.replace("`", ""), [*numbers, *_as_a_wave(numbers)], change.effect)
    return Remedy(known.physics, _why(found, change), known.confirm, f"{before}{cure}{after}", rule)


def is_open(change: Change) -> bool:
    """Whether neither how large a cause is, nor what is left without the change, says that it is to be taken back."""
    return not change.known_sense and not change.is_better_back


def _if_more(found: Comparison, change: Change) -> str:
    """What is said before a cure that may be none, and what settles whether it is one."""
    where, others = enumerated(change.where), enumerated(change.against)
    known = f"Whether there is more of it in {where} than in {others} or less is not known"
    if found.of_arms:
        return f"{known}: diagnose each, and mend {where} only if it is the one with more. Then: "
    return (
        f"{known}: it stays if it was repaired, and is taken back if it came with a crash. The log says which, or "
        f"{'its mastering mark, or ' * (change.effect == JOINT_OFFSET.name)}a diagnosis of each. After a crash: "
    )


def _all_of_it(change: Change) -> str:
    """That a number is no change."""
    (number,) = change.parameters
    size = size_of(number.difference, number.unit, sign=True)
    return f" That is all of it as it is now: it went through to the other side, by {size}."


def _on_the_other_side(found: Comparison, change: Change) -> Parameter | None:
    """The number as it is now, where it surely is on the other side of zero than before: that is what is to be mended.

    By its change, more would be taken back than there is.
    """
    if change.kind != "changed" or len(change.parameters) != 1:
        return None
    (number,) = change.parameters
    values, errors = np.array(number.values), np.array(number.stderrs)
    (before, _), (now, error) = (
        (float(np.mean(values[of])), float(np.sqrt(np.mean(errors[of] ** 2))))
        for of in (np.isin(found.names, change.against), np.isin(found.names, change.where))
    )
    surely = np.abs(values) > INTERVAL * errors
    surely = surely[np.isin(found.names, (*change.against, *change.where))].all()
    return Parameter(number.name, number.unit, now, error) if surely and before * now < 0 else None


def _nothing_to_mend(change: Change) -> str:
    """That nothing is corrected, because there is less of the cause now, or because other causes make up for it."""
    where, others = enumerated(change.where), enumerated(change.against)
    if change.is_hidden:
        hides = "What all recordings share makes up for it"
        return (
            f"Nothing is to be corrected by this alone.{_worth(change)} {hides}: diagnose {where} and mend all of it."
        )
    less = f"there is less of it in {where} than in {others}, and to take the change back would bring it again"
    if change.is_better_back:
        return f"Nothing is to be corrected: {less}. Other errors of the arm come out by it: diagnose {where}."
    return f"Nothing is to be corrected: {less}.{_worth(change)}"


def _worth(change: Change) -> str:
    """What taking a change back would do; empty where it is not known, or may be nothing."""
    if not abs(change.worse_sigmas) > COMPARING.clearly_worse:
        return ""
    now, back = millimetres(change.left_mm), millimetres(change.taken_back_mm)
    return f" Taken back, {back} in place of {now} per axis would be left in {enumerated(change.where)}."


def difference_of(number: Valued) -> Parameter:
    """A number's change as a parameter, with the standard error that its interval stands for."""
    low, high = number.interval_95
    return Parameter(number.name, number.unit, number.difference, (high - low) / 2 / INTERVAL)


def _as_a_wave(numbers: Sequence[Parameter]) -> list[Parameter]:
    """Amplitude, count and phase of what is told as one cosine and one sine; none of what is no single wave."""
    parts = {each.name.partition("_")[0]: each for each in numbers}
    if len(numbers) != len(parts) or set(parts) != {"cosine", "sine"}:
        return []
    cosine, sine = parts["cosine"], parts["sine"]
    count = cosine.name.partition("_")[2]
    if not count.isdigit():
        return []
    size = math.hypot(cosine.value, sine.value) or math.nan
    along, across = np.array([[cosine.value, sine.value], [sine.value, cosine.value]]) / size
    errors = np.array([cosine.stderr, sine.stderr])
    return [
        Parameter("amplitude", cosine.unit, size, float(np.linalg.norm(along * errors))),
        Parameter("per_turn", "", float(count), math.nan),
        Parameter("phase", "rad", math.atan2(sine.value, cosine.value), float(np.linalg.norm(across * errors)) / size),
    ]


def _why(found: Comparison, change: Change) -> str:
    """Where to look first."""
    if found.of_arms:
        return f"Look at what is done to each arm alone: how {change.where[0]} was assembled, mastered and mounted."
    earlier = [name for name in found.names[: found.names.index(change.where[0])] if name in change.against]
    between = f'between "{earlier[-1]}" and "{change.where[0]}"' if earlier else f'before "{change.where[0]}"'
    other_side = _on_the_other_side(found, change) is not None
    if change.is_less and change.effect != ANOTHER_LOAD.name and not other_side:
        return (
            f"If that is what was repaired {between}, the repair worked. Else find out what happened then: something "
            "was corrected in the controller, a joint was homed anew, or another cause now makes up for it."
        )
    if over := found.over_in(change):
        between = f'{between}, and again before "{over}"'
    return f"Find out what happened {between}: a crash, a repair, a joint homed anew, something that came loose."


def _words(known: Effect, location: str, differences: list[Parameter], verb: str) -> dict[str, str]:
    """What instructions name (`armscope.verdict.tasks`), told of the change."""
    by_name = {each.name: each for each in differences}
    words = dict.fromkeys(("zero", "ratio", "soft_turn", "coefficient"), "–")
    words |= {"location": location, "size": "", "jump": "", "correction": "take what changed back in the command"}
    words["bars"] = bars_set_right(differences)
    told = (f"{each.name} {length(each.value, each.stderr)}" for each in differences if each.unit == "mm")
    turned = (f"{each.name} {angle(each.value, each.stderr)}" for each in differences if each.unit == "rad")
    words["row"] = f"what stood there and {enumerated([*told, *turned])}"
    if "offset" in by_name:
        words["zero"] = f"{verb} by {angle(by_name['offset'].value, by_name['offset'].stderr)}"
    if "compliance" in by_name:
        words["size"] = f" (minus {read_parameter(by_name['compliance'], known.name).value} × load)"
    if "coupling" in by_name:
        back = replace(by_name["coupling"], value=-by_name["coupling"].value)
        words["coefficient"] = read_parameter(back, known.name).value
    if "ratio" in by_name:
        words["ratio"] = f"{1 / (1 + by_name['ratio'].value):.6f}"
    return words
