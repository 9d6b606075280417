"""The proof on sealed worlds of arms in motion, step by step."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import Commands, Output
from armscope.cli.studies import read_seed, size_of, worlds_in
from armscope.core.inputs import folder_of

app = Commands("proof motion", no_args_is_help=True)


@app.command()
def worlds(
    robots: Annotated[Path, typer.Argument(help="folder of the moving arms' descriptions")],
    seed_file: Annotated[Path, typer.Option(help="as `armscope proof seed` writes it")],
    visible: Annotated[Path, typer.Option(help="folder for what may be seen")],
    sealed: Annotated[Path, typer.Option(help="archive for the truth")],
    size: Annotated[str, typer.Option(help="small or full")] = "small",
) -> None:
    """Make moving worlds: motions with concealed causes, and the truth in an archive of its own."""
    from armscope.proof.motion.making import make

    seed = read_seed(seed_file)["proof_seed"]
    make(seed, size_of(size), folder_of(robots, "the moving arms"), visible, sealed)


@app.command()
def diagnose(
    folder: Annotated[Path, typer.Argument(help="folder of worlds: robot.yaml and motions.csv of each")], output: Output
) -> None:
    """Diagnose every world of a folder and predict its test path, each by its visible files alone."""
    from armscope.proof.motion.diagnosing import diagnose_worlds

    diagnose_worlds(worlds_in(folder), output)


@app.command()
def score(
    folder: Annotated[Path, typer.Argument(help="folder with visible, sealed.tar.gz, verdicts and seen.txt")],
    output: Output,
) -> None:
    """Unseal the truth, compare it with the verdicts, and write cases (proof.csv and others) and their summary."""
    from armscope.core.files import write_table, write_text
    from armscope.proof.motion.rates import in_words, per_effect, summary
    from armscope.proof.motion.reading import read_worlds
    from armscope.proof.motion.scoring import score as score_worlds

    cases = score_worlds(read_worlds(folder_of(folder, "the proof")))
    told = summary(cases)
    tables = {**cases, "summary": told, "per_effect": per_effect(cases)}
    for name, table in tables.items():
        write_table(output / f"{'proof' if name == 'worlds' else name}.csv", table, digits=6)
    write_text(output / "summary.md", in_words(told))
    print(in_words(told))


@app.command()
def page(
    docs: Annotated[Path, typer.Argument(help="folder of motion-causes.md and motion-measured.md: docs")],
    of: Annotated[str, typer.Option(help="what the results are of: 'commit ..., the small proof'")],
    proof: Annotated[Path | None, typer.Option(help="folder of the scores: summary.csv, proof.csv")] = None,
    real: Annotated[Path | None, typer.Option(help="folder with verdict.json of each real set in its folder")] = None,
) -> None:
    """Fill the tables of docs/motion-causes.md and motion-measured.md from the library and from results."""
    from armscope.report.pages.motion_docs import fill_motion_pages

    fill_motion_pages(docs, proof, real, of)
