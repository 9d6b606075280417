"""What sizes learned from a fleet do for the next arm of a type, measured on few poses: names, intervals, false names.

Twenty simulated arms of each of three types are diagnosed; further arms of these types, and arms without any error, are
then diagnosed on few rows, each without and with what the twenty have shown. Scored as the proof scores.

    python -m benchmarks.fleet_priors [--arms 40] [--rows 20 40]
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from armscope.core.files import write_yaml
from armscope.diagnosis import Settings, diagnose
from armscope.fleet.members import Member, diagnose_members
from armscope.fleet.simulation import WEAKNESSES, arm_spec
from armscope.fleet.summary import arms, causes_of_arms, learned_sizes, priors, repeated, verdicts
from armscope.proof.answers import NamedEffect
from armscope.proof.intervals import compare_numbers
from armscope.proof.matching import match
from armscope.proof.truth import Truth, seal, unseal
from armscope.recordings import read_recordings
from armscope.robot import Arm, load_arm
from armscope.robot.arm_type import read_arm_type
from armscope.world.folder import build

ROBOTS = Path(__file__).parents[1] / "config" / "robots"
FLEET, FLEET_SEED, SEED = 20, 2006, 2007
QUICK = Settings(resamples=0, cross_validation=False)


def learned(home: Path) -> Path:
    """priors.yaml of a fleet of so many arms of each type."""
    members = []
    for number in range(FLEET * len(WEAKNESSES)):
        spec = arm_spec(number, 10**9, FLEET_SEED)  # none is unlike the others
        visible = build(spec, home / "fleet", ROBOTS) / "visible"
        members.append(Member(spec.id, spec.arm, visible / "robot.yaml", visible / "recordings.csv"))
    diagnose_members(members, home / "verdicts", QUICK)
    found, _ = verdicts(members, [home / "verdicts"])
    often = repeated(causes_of_arms(members, found), arms(members, found))
    write_yaml(home / "priors.yaml", priors(often, learned_sizes(members, found)))
    return home / "priors.yaml"


def scored(truth: Truth, arm: Arm, table: Path) -> Iterator[tuple[str, float]]:
    """What a diagnosis got right, as (what, value)."""
    verdict = diagnose(arm, read_recordings(table, arm.n_motors), QUICK)
    claims = [NamedEffect.of(effect) for effect in verdict.effects if not effect.minor]
    matches, left = match([effect for effect in truth.effects if not effect.minor], claims)
    yield "false names", float(len(left))
    for each in matches:
        right = each.claim is not None and each.claim.name == each.truth.name
        yield "right names", float(right)
        for number in compare_numbers(each.truth, [each.claim], None) if right and each.truth.comparable else ():
            if number.covered is not None and number.stderr > 0 and number.true:
                yield "covered", float(number.covered)
                yield "log half width", float(np.log(number.stderr / abs(number.true)))
                yield "log error", float(np.log(abs(number.fitted - number.true) / abs(number.true) + 1e-6))


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=40, help="with errors, and as many without, per number of rows")
    parser.add_argument("--rows", type=int, nargs="+", default=[20, 40])
    parser.add_argument("--weaker", type=float, default=1.0, help="errors of the next arms are so many times smaller")
    asked = parser.parse_args()
    seen = []
    with tempfile.TemporaryDirectory() as made:
        home = Path(made)
        file = learned(home)
        for rows in asked.rows:
            for number in range(2 * asked.arms):
                spec = arm_spec(number, 10**9, SEED).model_copy(
                    update={"rows": rows, "id": f"next-{rows}-{number:03d}"}
                )
                smaller = [each.model_copy(update={"strength": each.strength / asked.weaker}) for each in spec.effects]
                spec = spec.model_copy(update={"effects": tuple(smaller)})
                if number % 2:
                    spec = spec.model_copy(update={"category": "clean", "effects": ()})
                world = build(spec, home / "next", ROBOTS)
                seal(world.parent, home / "truth.tar")
                truth = unseal(home / "truth.tar")[spec.id]
                arm = load_arm(world / "visible" / "robot.yaml")
                for how, one in (("without", arm), ("with", replace(arm, type=read_arm_type(file, spec.arm)))):
                    found = scored(truth, one, world / "visible" / "recordings.csv")
                    seen += [(rows, "clean" if number % 2 else "arms with errors", what, how, v) for what, v in found]
    table = pd.DataFrame(seen, columns=["rows", "arms", "what", "how", "value"])
    sums = table.groupby(["rows", "arms", "what", "how"])["value"].agg(["count", "sum", "mean"]).unstack("how")
    print(sums.round(3).to_string())


if __name__ == "__main__":
    main()
