"""Findings on real arms, step by step: the reference protocol, concealment on real recordings, pages."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(no_args_is_help=True)

Output = Annotated[Path, typer.Option("--output", "-o", help="where to write")]


@app.command()
def protocol(
    recordings: Annotated[Path, typer.Argument(help="recordings of a real arm, all runs")],
    robot: Annotated[Path, typer.Argument(help="its robot.yaml")],
    reference: Annotated[Path, typer.Argument(help="reference.yaml: runs, splits and figures of others")],
    output: Output,
    diagnosed_splits: Annotated[int | None, typer.Option(help="diagnose on so many splits only")] = None,
) -> None:
    """Held-out figures in the reference protocol: plain calibrations, the paper's models, armscope; and transfers."""
    import pandas as pd

    from armscope.files import write_table
    from armscope.real.protocol import measure_run, protocol_table
    from armscope.real.reference import load_reference
    from armscope.real.transfer import measure_transfer, transfer_table
    from armscope.recordings import read_recordings
    from armscope.robot import load_arm

    arm, stated = load_arm(robot), load_reference(reference)
    table = read_recordings(recordings, arm.n_motors)
    found = [measure_run(arm, table, run, diagnosed_splits, _tell) for run in stated.runs]
    splits = pd.concat([each.splits for each in found], ignore_index=True)
    write_table(output / "splits.csv", splits, digits=6)
    write_table(output / "names.csv", pd.concat([each.names for each in found], ignore_index=True), digits=6)
    write_table(output / "protocol.csv", pd.concat([protocol_table(splits, run) for run in stated.runs]), digits=6)
    carried = [(transfer, measure_transfer(arm, table, transfer, _tell)) for transfer in stated.transfers]
    write_table(output / "transfer.csv", transfer_table(carried), digits=6)


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
