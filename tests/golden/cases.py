"""What the golden verdicts are of: the examples, worlds of every category, a long table, a real recording.

    python -m tests.golden.cases OUT            # verdict.json and model.yaml of every case, to compare byte by byte
    python -m tests.golden.cases OUT --only examples
    python -m tests.golden.cases --digest       # what tests/golden/test_golden.py compares with, written anew

The real recording lies beside the checkout and is left out where it is missing; nothing of it is kept in the project.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from armscope.diagnosis import Settings, Verdict, diagnose, write_verdict
from armscope.recordings import read_recordings
from armscope.robot import load_arm
from armscope.world.catalogue import catalogue
from armscope.world.folder import build
from armscope.world.spec import WorldSpec

ROOT = Path(__file__).parents[2]
REAL = ROOT.parent / "shared" / "recordings" / "iiwa7-payload"
RUN_OF_REAL = "2016-11-18"
LONG = "world-long"
DIGEST = Path(__file__).with_name("golden.json")
QUICK = Settings(resamples=0, cross_validation=False)


def chosen_worlds() -> list[WorldSpec]:
    """Ten worlds of fixed seeds: the first of every category but the roughest, which take long, and one longer than the
    search takes at once.
    """
    fixed = [spec for spec in catalogue(0, "full") if not spec.fresh]
    first: dict[str, WorldSpec] = {}
    for spec in fixed:
        if not spec.rough:
            first.setdefault(spec.category, spec)
    multiple = first["multiple"]
    return [*first.values(), multiple.model_copy(update={"id": LONG, "rows": 3300})]


EXAMPLES_AGAIN = ("five-effects", "seven-axes-modified-dh")
"""The one that takes longest, and one that is diagnosed by tests/diagnosis/test_diagnose.py as well."""
AGAIN = ("clean", "single", "multiple", "real", "bad_shots", "inseparable", "misleading")
"""Categories of which an example is one as well, and those that take longest."""


def verdicts(only: str = "") -> Iterator[tuple[str, Verdict]]:
    """Every case's name and verdict; of the worlds all, or those of `AGAIN`, or the others, or the long one."""
    for example in sorted(path.parent for path in (ROOT / "examples").glob("*/recordings.csv")):
        if only in ("", "examples") or only == ("again" if example.name in EXAMPLES_AGAIN else "others"):
            yield example.name, diagnosed(example, Settings(resamples=2))
    if only in ("", "worlds", "again", "others", "long"):
        with tempfile.TemporaryDirectory() as made:
            for spec in chosen_worlds():
                kind = "long" if spec.id == LONG else "again" if spec.category in AGAIN else "others"
                if only not in ("", kind) and (only != "worlds" or kind == "long"):
                    continue
                home = build(spec, Path(made), ROOT / "config" / "robots")
                yield f"{spec.id}-{spec.category}", diagnosed(home / "visible", QUICK)
    if only in ("", "real") and REAL.exists():
        arm = load_arm(REAL / "robot.yaml")
        table = read_recordings(REAL / "recordings.csv.gz", arm.n_motors)
        yield "iiwa-with-orientations", diagnose(arm, table.rows(table.run == RUN_OF_REAL), QUICK)


def diagnosed(folder: Path, settings: Settings) -> Verdict:
    """The verdict on a folder's robot.yaml and recordings.csv."""
    arm = load_arm(folder / "robot.yaml")
    return diagnose(arm, read_recordings(folder / "recordings.csv", arm.n_motors), settings)


def digest(verdict: Verdict) -> dict[str, Any]:
    """What a verdict says, in short: names, places, values."""
    return {
        "answer": verdict.answer,
        "noise_mm": verdict.noise_mm,
        "held_out_mm": verdict.held_out.after,
        "effects": [
            {
                "effect": f"{found.effect} at {found.location}",
                "rms_at_tool_mm": found.rms_at_tool_mm,
                "share": found.share,
                "evidence_nats": found.evidence_nats,
                "parameters": {p.name: [p.value, p.stderr] for p in found.parameters},
                "alternatives": [f"{other.effect} at {other.location}" for other in found.alternatives],
            }
            for found in verdict.effects
        ],
    }


def main() -> None:
    """Write the cases' files, or the digests that the test compares with."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", nargs="?", type=Path)
    parser.add_argument("--only", default="", choices=("", "examples", "worlds", "real"))
    parser.add_argument("--digest", action="store_true")
    asked = parser.parse_args()
    digests = {}
    for name, verdict in verdicts(asked.only):
        print(name, verdict.headline, file=sys.stderr)
        if asked.output:
            write_verdict(verdict, asked.output / name)
        if not name.startswith("iiwa"):
            digests[name] = digest(verdict)
    if asked.digest:
        DIGEST.write_text(json.dumps(digests, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
