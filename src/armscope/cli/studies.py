"""What the commands of a study share: its files, and settings given as JSON."""

from __future__ import annotations

import gzip
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armscope.inputs import InputError, Model, validate

if TYPE_CHECKING:
    import pandas as pd

    from armscope.errormodels import FittedModel
    from armscope.paper.measurements import Measurements

Settings = Annotated[str, typer.Option(help="JSON: the parts of the configuration that this step follows")]
Output = Annotated[Path, typer.Option("--output", "-o", help="where to write")]
Poses = Annotated[Path, typer.Argument(help="poses.csv of a study")]
Errors = Annotated[Path, typer.Argument(help="errors.csv of a study")]
Fits = Annotated[Path, typer.Argument(help="fits.json.gz of a study")]
Residuals = Annotated[list[Path], typer.Argument(help="residuals of the robot to show, then of its ensemble")]
ManyErrors = Annotated[list[Path], typer.Option("--errors", help="errors of the robot to show, then of its ensemble")]
ManyFits = Annotated[list[Path], typer.Option("--fits", help="fits of the robot to show, then of its ensemble")]


def parsed(model: type[Model], settings: str) -> Model:
    """Settings given as JSON.

    Raises:
        InputError: no JSON, or not what the step needs.
    """
    try:
        content = json.loads(settings)
    except json.JSONDecodeError as error:
        raise InputError("--settings", f"character {error.pos}", settings, "this must be JSON", error.msg) from error
    return validate(model, content, "--settings")


def read_measurements(poses: Path, *errors: Path) -> Measurements:
    """The measurements of a study; several tables of errors follow each other."""
    import pandas as pd

    from armscope.paper.measurements import Measurements

    return Measurements.from_tables(pd.read_csv(poses), read_tables(errors))


def read_tables(paths: Sequence[Path]) -> pd.DataFrame:
    """Tables of the same columns, one after the other."""
    import pandas as pd

    return pd.concat([pd.read_csv(path) for path in paths], ignore_index=True)


def write_fits(path: Path, fits: Sequence[FittedModel]) -> None:
    """Fitted models as compressed JSON, the same bytes for the same fits."""
    from armscope.files import replacing

    with replacing(path) as beside:
        beside.write_bytes(gzip.compress(json.dumps([fit.to_dict(history=True) for fit in fits]).encode(), mtime=0))


def read_fits(*paths: Path) -> list[FittedModel]:
    """Fitted models that `write_fits` wrote, file by file."""
    from armscope.errormodels import FittedModel

    contents = [content for path in paths for content in json.loads(gzip.decompress(path.read_bytes()))]
    return [FittedModel.from_dict(content) for content in contents]
