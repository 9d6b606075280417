"""Commands of the diagnosis: predict."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def predict(
    model: Annotated[Path, typer.Argument(help="model.yaml, as `armscope diagnose` writes it")],
    poses: Annotated[Path, typer.Argument(help="a table of motor angles and whatever context the model follows")],
    output: Annotated[Path, typer.Option("--output", "-o", help="table to write: id, run, x_mm, y_mm, z_mm")],
) -> None:
    """Predict where the arm's tool point will be, in the measurement frame."""
    import pandas as pd

    from armscope.files import write_table
    from armscope.physics.model import load_model
    from armscope.physics.model import predict as predicted_points
    from armscope.recordings import read_recordings

    fitted = load_model(model)
    recordings = read_recordings(poses, fitted.arm.n_motors, measured=False)
    points = pd.DataFrame(predicted_points(fitted, recordings) * 1e3, columns=["x_mm", "y_mm", "z_mm"])
    write_table(output, pd.concat([pd.DataFrame({"id": recordings.id, "run": recordings.run}), points], axis=1))
    for run in fitted.unknown_runs(recordings):
        print(f"run {run!r} is not in the model: its base is taken from run {list(fitted.bases)[-1]!r}")
