"""The developers' bench: simulated arms with their truth, which somebody else's engine made; not part of the project.

    python -m tools.bench run BENCH -o FOLDER d001 d002      # diagnoses and predicts each case
    python -m tools.bench score BENCH -o results/bench FOLDER ...   # by its own score.py: figures.json, table.md

`snakemake bench` does both. Only the figures of it are ever told: `python -m tools.why_a_name --rates`.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import binomtest

from armscope.core.files import copy_file, read_json, write_json, write_text
from armscope.core.inputs import InputError
from armscope.core.words import table_lines

ROOT = Path(__file__).parents[1]
FAMILIES = {
    "realistic": "everything a little wrong, one or two effects dominate",
    "misleading": "masses wrong, base moved, two-axis base, context that misleads",
    "outside": "physics without a name: to be located, not misnamed",
    "ambiguous": "poses that can't tell two names apart: both must be said",
    "multi": "two to four effects",
    "single_faint": "one effect about as large as the noise",
    "single_plain": "one effect of 3.5–7 times the noise",
    "control": "noise only: nothing to be named",
}
"""What each family of cases conceals, the harder ones first."""
BEGIN, END = "<!-- bench: begin", "<!-- bench: end -->"
MEASURED = ("x_mm", "y_mm", "z_mm")
Figures = Mapping[str, Any]


def run(bench: Path, folder: Path, cases: Iterable[str]) -> None:
    """Diagnose cases by the command line, and predict the poses that were held out, without what was measured there.

    Args:
        bench: its folder.
        folder: where a folder per case goes; a case that fails leaves no verdict and counts as not answered.
        cases: their ids.
    """
    for case in cases:
        seen, made = bench / "cases" / case, folder / case
        made.mkdir(parents=True, exist_ok=True)
        poses = made / "poses.csv"
        pd.read_csv(seen / "test.csv", dtype=str).drop(columns=list(MEASURED)).to_csv(poses, index=False)
        answer = made / "diagnosis"  # it holds a predicted.csv of its own, of the recorded rows
        if _armscope("diagnose", seen / "recordings.csv", "--robot", seen / "robot.yaml", "-o", answer):
            copy_file(answer / "verdict.json", made / "verdict.json")
            _armscope("predict", answer / "model.yaml", poses, "-o", made / "predicted.csv")


def _armscope(*arguments: str | Path) -> bool:
    ended = subprocess.run([sys.executable, "-m", "armscope", *map(str, arguments)], check=False)
    if ended.returncode:
        print(f"failed: armscope {' '.join(map(str, arguments))}", file=sys.stderr)
    return ended.returncode == 0


def score(bench: Path, folders: Sequence[Path]) -> dict[str, Any]:
    """What the bench's own scorer says of the verdicts in some folders, which hold a folder per case.

    Args:
        bench: its folder.
        folders: of `run`.

    Returns:
        Its JSON, whole.
    """
    with tempfile.TemporaryDirectory() as name:
        runs, raw = Path(name) / "runs", Path(name) / "raw.json"
        runs.mkdir()
        for each in sorted(case for folder in folders for case in folder.iterdir() if case.is_dir()):
            if not each.name.startswith("."):
                (runs / each.name).symlink_to(each.resolve())
        subprocess.run([sys.executable, bench / "score.py", "--runs", runs, "--json", raw], check=True)
        return dict(json.loads(raw.read_text(encoding="utf-8")))


def figures(scored: Figures, commit: str) -> dict[str, Any]:
    """The figures that are told: counts by family, and nothing of any single case.

    Args:
        scored: see `score`.
        commit: of the code that was run.

    Returns:
        commit, and per family cases, right, false_names, held_out_ratio (median error over that of the truth
        itself), intervals and how many of them hold the truth.
    """
    families = {}
    for family in FAMILIES:
        cases = [case for case in scored["cases"] if case["family"] == family]
        held = [case["ratio"] for case in cases if case["ratio"] is not None]
        covered = [pair[1] for case in cases for pair in case["pairs"] if pair[1] is not None]
        families[family] = {
            "cases": len(cases),
            "right": sum(bool(case["right"]) for case in cases),
            "false_names": sum(case["fp"] for case in cases),
            "held_out_ratio": float(np.median(held)) if held else None,
            "intervals": len(covered),
            "covered": sum(map(bool, covered)),
        }
    return {"commit": commit, "families": families}


def table(told: Figures) -> str:
    """The whole table, by family, as Markdown."""
    head = (
        "family", "what is concealed", "cases", "right", "exact 95 % interval", "false names",
        "held-out error over the truth's own (median)", "95 % intervals that hold the truth",
    )  # fmt: skip
    rows = []
    for family, row in _rows(told):
        ratio = "–" if row["held_out_ratio"] is None else f"{row['held_out_ratio']:.3f}"
        covered = f"{row['covered']} of {row['intervals']}" if row["intervals"] else "–"
        cells = [_words(family), FAMILIES[family], row["cases"], row["right"], _interval(row), row["false_names"]]
        rows.append((*cells, ratio, covered))
    return "\n".join([*table_lines(head, rows), "", _source(told)])


def short_table(told: Figures) -> str:
    """Names right, by family, as Markdown."""
    rows = (
        (f"{_words(family)}: {FAMILIES[family]}", row["cases"], row["right"], _interval(row), row["false_names"])
        for family, row in _rows(told)
    )
    head = ("names right, by family", "cases", "right", "exact 95 % interval", "false names")
    return "\n".join([*table_lines(head, rows), "", _source(told)])


def _rows(told: Figures) -> list[tuple[str, Figures]]:
    return [(family, told["families"][family]) for family in FAMILIES if told["families"][family]["cases"]]


def _words(family: str) -> str:
    return family.replace("_", ", ")


def _interval(row: Figures) -> str:
    interval = binomtest(row["right"], row["cases"]).proportion_ci(0.95)
    return f"{100 * interval.low:.0f}–{100 * interval.high:.0f} %"


def _source(told: Figures) -> str:
    cases = sum(row["cases"] for _, row in _rows(told))
    return (
        f"Run on commit {told['commit']}, {cases} arms simulated by an independent engine. *These cases were used for "
        "development: whoever worked on the diagnosis saw where it was wrong on them. So the rates are not a blind "
        "measure, and on other arms they may well be lower.*"
    )


def fill(path: Path, root: Path = ROOT) -> None:
    """Put the tables between the marks of docs/why-a-name.md and README.md.

    Args:
        path: figures.json.
        root: the checkout.

    Raises:
        InputError: a page has no marks.
    """
    told = read_json(path, "figures of the bench")
    for page, text in ((root / "docs" / "why-a-name.md", table(told)), (root / "README.md", short_table(told))):
        write_text(page, filled(page, page.read_text(encoding="utf-8"), text))


def filled(page: Path, text: str, block: str) -> str:
    """A page's text with what stands between the marks replaced."""
    before, begin, rest = text.partition(BEGIN)
    mark, _, rest = rest.partition("\n")
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise InputError(page, "", "no marks", f"the figures go between {BEGIN!r} and {END!r}")
    return f"{before}{BEGIN}{mark}\n\n{block}\n\n{END}{after}"


def _commit() -> str:
    command = ["git", "describe", "--always", "--dirty", "--exclude", "*"]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def main() -> None:
    """Run some cases, or score all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("run", "score"))
    parser.add_argument("bench", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--commit", help="of the code that was run; that of the checkout where not given")
    parser.add_argument("of", nargs="+", help="run: cases; score: folders that hold a folder per case")
    chosen = parser.parse_intermixed_args()
    if chosen.what == "run":
        run(chosen.bench, chosen.output, chosen.of)
        return
    told = figures(score(chosen.bench, [Path(each) for each in chosen.of]), chosen.commit or _commit())
    write_json(chosen.output / "figures.json", told)
    write_text(chosen.output / "table.md", table(told) + "\n")


if __name__ == "__main__":
    main()
