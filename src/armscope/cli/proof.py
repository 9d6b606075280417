"""The proof on concealed effects, step by step: worlds are made, diagnosed, unsealed, scored and shown."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from armscope.cli import motion_proof
from armscope.cli.commands import Commands, Output
from armscope.cli.studies import every_nth, read_seed, size_of, worlds_in
from armscope.core.inputs import InputError, folder_of

app = Commands("proof", no_args_is_help=True)
app.add_typer(motion_proof.app, name="motion", help="The same for arms in motion.")


@app.command()
def seed(
    output: Output,
    fixed: Annotated[int | None, typer.Option(help="this one; otherwise it is drawn from the system's entropy")] = None,
) -> None:
    """Draw the seed of the worlds that nobody can know beforehand, and record it."""
    import secrets

    from armscope.core.files import write_json

    drawn = fixed is None
    write_json(output, {"proof_seed": secrets.randbelow(2**31) if fixed is None else fixed, "drawn": drawn})


@app.command()
def worlds(
    robots: Annotated[Path, typer.Argument(help="folder of the arms' descriptions")],
    size: Annotated[str, typer.Option(help="small or full")],
    half: Annotated[str, typer.Option(help="fixed or fresh seeds")],
    part: Annotated[str, typer.Option(help="which part of how many, as in 0/4")],
    visible: Annotated[Path, typer.Option(help="folder for what may be seen")],
    sealed: Annotated[Path, typer.Option(help="archive for the truth")],
    seed_file: Annotated[Path | None, typer.Option(help="as `armscope proof seed` writes it; for fresh seeds")] = None,
) -> None:
    """Make a batch of worlds: recordings with concealed effects, and the truth in an archive of its own."""
    from armscope.proof.making import batch, make

    mine = every_nth(part)
    if half not in ("fixed", "fresh"):
        raise InputError("--half", "", half, "fixed or fresh")
    drawn = read_seed(seed_file)["proof_seed"] if seed_file else 0
    make(batch(drawn, size_of(size), half == "fresh")[mine], robots, visible, sealed)


@app.command()
def diagnose(
    folder: Annotated[Path, typer.Argument(help="folder of worlds: robot.yaml and recordings.csv of each")],
    output: Output,
    resamples: Annotated[int, typer.Option(help="how often rows are resampled")] = 0,
    cross_validation: Annotated[bool, typer.Option(help="whether each verdict is cross-validated")] = False,
) -> None:
    """Diagnose every world of a folder, each by its visible files alone."""
    from armscope.diagnosis import Settings
    from armscope.proof.diagnosing import diagnose_worlds

    settings = Settings(resamples=resamples, cross_validation=cross_validation)
    diagnose_worlds(worlds_in(folder), output, settings)


@app.command()
def score(
    folder: Annotated[Path, typer.Argument(help="folder with visible, sealed, verdicts and seen")], output: Output
) -> None:
    """Unseal the truth, compare it with the verdicts, and write tables of cases and of rates."""
    from armscope.core.files import write_table
    from armscope.proof.rates import tables
    from armscope.proof.reading import read_worlds
    from armscope.proof.scoring import score as score_worlds

    for part in ("visible", "sealed", "verdicts", "seen"):
        folder_of(folder / part, f"the proof's {part}")
    for name, table in tables(score_worlds(read_worlds(folder))).items():
        write_table(output / f"{name}.csv", table, digits=6)


@app.command()
def figures(
    tables: Annotated[Path, typer.Argument(help="folder of the tables that `armscope proof score` writes")],
    output: Output,
) -> None:
    """Draw the proof: aims, power curves, confusions, scores per effect, outcomes, held-out rows."""
    from armscope.report.figures.proof import draw_all
    from armscope.report.style import save_figure

    for name, figure in draw_all(_scored(tables)).items():
        save_figure(figure, output / name, formats=("png", "svg"))


@app.command()
def report(
    tables: Annotated[Path, typer.Argument(help="folder of the tables")],
    drawn: Annotated[Path, typer.Argument(help="folder of the figures")],
    seed_file: Annotated[Path, typer.Argument(help="as `armscope proof seed` writes it")],
    output: Output,
    size: Annotated[str, typer.Option(help="small or full")] = "small",
) -> None:
    """One page: what the diagnosis finds, what it misses, and what it gets wrong."""
    from armscope.report.pages.proof import write_proof_page

    write_proof_page(
        output, _scored(tables), folder_of(drawn, "the proof's figures"), read_seed(seed_file), size_of(size)
    )


def _scored(tables: Path) -> Path:
    from armscope.core.files import read_table

    read_table(folder_of(tables, "the proof's tables") / "aims.csv", what="a table of `armscope proof score`")
    return tables
