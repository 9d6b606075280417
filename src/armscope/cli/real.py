"""Findings on real arms, step by step: the reference protocol, concealment on real recordings, pages."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from armscope.cli.commands import Commands, Output
from armscope.cli.studies import Settings, parsed, read_seed
from armscope.core.inputs import InputError, Strict, folder_of


class PlantSettings(Strict):
    """`armscope real plant`: which rows of which arm, what is concealed in them, and how large."""

    seed: int
    title: str
    run: str | None
    first_id: int | None
    most_rows: int
    effects: tuple[str, ...]
    sizes: tuple[float, ...]


class PagedArm(Strict):
    """A set on the page of real arms."""

    name: str
    title: str
    folder: str
    reference: str
    run: str | None
    first_id: int | None


class PageSettings(Strict):
    """`armscope real page`: which arms."""

    arms: tuple[PagedArm, ...]


class ConcealedSettings(Strict):
    """`armscope real concealed`: the tables of the concealment, and what to call each arm."""

    proof: str
    titles: dict[str, str]


app = Commands("real", no_args_is_help=True)
Of = Annotated[str, typer.Option(help="what the results are of: 'commit ...'")]
Recorded = Annotated[Path, typer.Argument(help="recordings of a real arm, all runs")]
ItsRobot = Annotated[Path, typer.Argument(help="its robot.yaml")]
Stated = Annotated[Path, typer.Argument(help="reference.yaml: runs, splits, and what others found")]


@app.command()
def protocol(
    recordings: Recorded,
    robot: ItsRobot,
    reference: Stated,
    output: Output,
    diagnosed_splits: Annotated[int | None, typer.Option(help="diagnose on so many splits only")] = None,
    oriented_splits: Annotated[int | None, typer.Option(help="of these, so many with orientations, too")] = None,
) -> None:
    """Held-out figures in the reference protocol: plain calibrations, the paper's models, armscope; and transfers."""
    import pandas as pd

    from armscope.core.files import write_table
    from armscope.real.curves import curve_table
    from armscope.real.protocol import measure_run, protocol_table
    from armscope.real.reference import load_reference
    from armscope.real.transfer import learn, measure_transfers, transfer_table
    from armscope.recordings import read_recordings
    from armscope.report.figures.protocol import draw_protocol
    from armscope.report.style import save_figure
    from armscope.robot import load_arm

    arm, stated = load_arm(robot), load_reference(reference)
    table = read_recordings(recordings, arm.n_motors)
    found = [measure_run(arm, table, run, diagnosed_splits, oriented_splits, _tell) for run in stated.runs]
    splits = pd.concat([each.splits for each in found], ignore_index=True)
    write_table(output / "splits.csv", splits, digits=6)
    write_table(output / "names.csv", pd.concat([each.names for each in found], ignore_index=True), digits=6)
    beside = pd.concat([protocol_table(splits, run) for run in stated.runs], ignore_index=True)
    write_table(output / "protocol.csv", beside, digits=6)
    save_figure(draw_protocol([(arm.name, beside)]), output / "protocol.png")
    verdicts = learn(arm, table, stated.transfers)
    write_table(output / "curves_by_run.csv", curve_table(verdicts), digits=6)
    carried = measure_transfers(arm, table, stated.transfers, verdicts, _tell)
    write_table(output / "transfer.csv", transfer_table(carried), digits=6)


@app.command()
def regions(recordings: Recorded, robot: ItsRobot, reference: Stated, output: Output) -> None:
    """Foretell whole regions that took no part: the last rows, the farthest, the highest, those on one side."""
    import pandas as pd

    from armscope.core.files import write_table
    from armscope.real.protocol import measure_regions
    from armscope.real.reference import load_reference
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    arm, stated = load_arm(robot), load_reference(reference)
    table = read_recordings(recordings, arm.n_motors)
    found = [measure_regions(arm, table, run, _tell) for run in stated.runs]
    write_table(output, pd.concat(found, ignore_index=True), digits=6)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


@app.command()
def compliances(
    recordings: Recorded,
    robot: ItsRobot,
    reference: Stated,
    output: Output,
    arms: Annotated[int, typer.Option(help="simulated arms on which the comparison is tried")] = 40,
    seed: Annotated[int, typer.Option(min=0, help="of the simulated arms")] = 0,
) -> None:
    """Do the drives' compliances agree between runs? Values, agreement, and the same on simulated arms."""
    from armscope.core.files import write_table
    from armscope.real.compliance_tables import compare_runs
    from armscope.real.reference import load_reference
    from armscope.real.simulated_comparison import compare_simulated_runs
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    arm, stated = load_arm(robot), load_reference(reference).compliances
    if stated is None:
        raise InputError(reference, "compliances", "nothing", "which runs to compare, and figures of others")
    table = read_recordings(recordings, arm.n_motors)
    if table.torque is None:
        raise InputError(recordings, "line 1", "no column tau1_nm", "drives are compared under recorded torques")
    values, pairs = compare_runs(arm, table, stated, _tell)
    write_table(output / "compliances.csv", values, digits=6)
    write_table(output / "compliances_agree.csv", pairs, digits=6)
    write_table(output / "compliances_simulated.csv", compare_simulated_runs(arm, table, stated, arms, seed))


@app.command()
def plant(
    recordings: Recorded,
    robot: ItsRobot,
    settings: Settings,
    part: Annotated[str, typer.Option(help="original, fixed, fresh or withheld")],
    visible: Annotated[Path, typer.Option(help="folder for what may be seen")],
    sealed: Annotated[Path, typer.Option(help="archive for the truth")],
    verdict: Annotated[Path | None, typer.Option(help="verdict.json of the original: sizes are relative to it")] = None,
    seed_file: Annotated[Path | None, typer.Option(help="as `armscope proof seed` writes it; for fresh places")] = None,
) -> None:
    """Conceal known effects in real recordings: what may be seen, and the truth in an archive of its own."""
    from armscope.cli.real import PlantSettings
    from armscope.real.making import Places, make_altered, make_original, make_withheld
    from armscope.real.prepared_recordings import of_run, prepared_recordings, with_payload
    from armscope.recordings.textfile import read_text_table
    from armscope.robot import load_arm
    from armscope.verdict.files import read_verdict

    chosen = parsed(PlantSettings, settings)
    arm, table, places = load_arm(robot), read_text_table(recordings), Places(robot, visible, sealed)
    mine = prepared_recordings(arm, of_run(table, chosen.run, chosen.first_id), chosen.most_rows, str(recordings))
    if part == "original":
        make_original(mine, places)
    elif part == "withheld":
        loaded = with_payload(table)
        by_name = {"run": mine} | (
            {"payloads": prepared_recordings(arm, loaded, chosen.most_rows)} if len(loaded) else {}
        )
        make_withheld(by_name, places)
    else:
        if verdict is None:
            raise InputError("--verdict", "", "nothing", "effects are sized by what the original's verdict leaves")
        level = read_verdict(verdict).residual_after_mm * 1e-3
        drawn = read_seed(seed_file)["proof_seed"] if seed_file else 0
        seed = [chosen.seed, drawn, *chosen.title.encode()]
        make_altered(mine, chosen.effects, chosen.sizes, level, seed, places)


@app.command()
def score(
    folder: Annotated[Path, typer.Argument(help="folder with visible, sealed, verdicts and seen")], output: Output
) -> None:
    """Unseal what was concealed in real recordings, compare it with the verdicts, and write tables."""
    from armscope.core.files import write_table
    from armscope.real.rates import tables
    from armscope.real.scoring import read_sealed
    from armscope.real.scoring import score as score_worlds

    for part in ("sealed", "verdicts", "seen"):
        folder_of(folder / part, f"the concealment's {part}")
    for name, table in tables(score_worlds(list(read_sealed(folder)))).items():
        write_table(output / f"{name}.csv", table, digits=6)


@app.command()
def report(
    folder: Annotated[Path, typer.Argument(help="folder of the tables that `armscope real score` writes")],
    seed_file: Annotated[Path, typer.Argument(help="as `armscope proof seed` writes it")],
    output: Annotated[Path, typer.Option("--output", "-o", help="folder for report.html and figures")],
    titles: Annotated[str, typer.Option(help="JSON: what to call each set")] = "{}",
) -> None:
    """One page with figures: are known effects found on top of all that real arms do?"""
    import json

    import pandas as pd

    from armscope.report.figures.real_proof import draw_all
    from armscope.report.pages.real_concealed import write_real_proof_page
    from armscope.report.style import save_figure

    named = json.loads(titles)
    files = folder_of(folder, "the tables of `armscope real score`").glob("*.csv")
    tables = {file.stem: pd.read_csv(file) if file.stat().st_size > 1 else pd.DataFrame() for file in files}
    for name, figure in draw_all(tables, named).items():
        save_figure(figure, output / "figures" / name, formats=("png", "svg"))
    write_real_proof_page(output / "report.html", tables, output / "figures", read_seed(seed_file), named)


@app.command()
def page(
    output: Annotated[Path, typer.Argument(help="the page, docs/real-arms.md; its figures go to figures/ beside it")],
    settings: Settings,
    of: Of,
) -> None:
    """Write what is wrong with each real arm, from results, with one figure each."""
    import pandas as pd

    from armscope.cli.real import PageSettings
    from armscope.core.files import copy_file
    from armscope.real.curves import shared
    from armscope.report.figures.compliances import draw_compliances
    from armscope.report.figures.learned_curves import draw_shared_curves
    from armscope.report.figures.protocol import draw_protocol
    from armscope.report.pages.real_arms import RealArm, write_real_arms
    from armscope.report.style import save_figure

    chosen = parsed(PageSettings, settings)
    arms = [RealArm(a.name, a.title, Path(a.folder), Path(a.reference), (a.run, a.first_id)) for a in chosen.arms]
    figures = output.parent / "figures"
    for arm in arms:
        copy_file(arm.folder / "figures" / "arm.svg", figures / f"real-{arm.name}.svg")
        if curves := shared(pd.read_csv(arm.folder / "curves_by_run.csv")):
            save_figure(draw_shared_curves(curves), figures / f"real-{arm.name}-curves.png", formats=("png",))
        if (told := arm.folder / "compliances.csv").exists():
            picture = figures / f"real-{arm.name}-compliances.png"
            save_figure(draw_compliances(pd.read_csv(told)), picture, formats=("png",))
    tables = [(arm.title.partition(",")[0], pd.read_csv(arm.folder / "protocol.csv")) for arm in arms]
    save_figure(draw_protocol(tables), figures / "real-protocol.png", formats=("png",))
    write_real_arms(output, arms, figures.name, of)


@app.command()
def concealed(
    output: Annotated[Path, typer.Argument(help="the page, docs/real-concealed.md")], settings: Settings, of: Of
) -> None:
    """Write how often known effects were found that were concealed in recordings of real arms, from results."""
    from armscope.cli.real import ConcealedSettings
    from armscope.report.pages.real_concealed import write_concealment

    chosen = parsed(ConcealedSettings, settings)
    write_concealment(output, Path(chosen.proof), chosen.titles, of)
