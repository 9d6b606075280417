"""What the commands of a study share: its files, and the settings of a step."""

from __future__ import annotations

import gzip
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from armscope.core.inputs import InputError, Model, folder_of, nearest, validate

if TYPE_CHECKING:
    import pandas as pd

    from armscope.errormodels.features import ModelSpec
    from armscope.errormodels.fitted import SwarmFit
    from armscope.paper.measurements import Measurements

Settings = Annotated[
    str, typer.Option(help="file (or text) in JSON: the parts of the configuration that this step follows")
]
Poses = Annotated[Path, typer.Argument(help="poses.csv of a study")]
Errors = Annotated[Path, typer.Argument(help="errors.csv of a study")]
Fits = Annotated[Path, typer.Argument(help="fits.json.gz of a study")]
Residuals = Annotated[list[Path], typer.Argument(help="residuals of the robot to show, then of its ensemble")]
ManyErrors = Annotated[list[Path], typer.Option("--errors", help="errors of the robot to show, then of its ensemble")]
ManyFits = Annotated[list[Path], typer.Option("--fits", help="fits of the robot to show, then of its ensemble")]


def parsed(model: type[Model], settings: str) -> Model:
    """Settings given as a JSON file, or as its text. Raises InputError: no JSON, or not what the step needs."""
    source, text = "--settings", settings
    if not settings.lstrip().startswith("{"):
        source = settings
        try:
            text = Path(settings).read_text(encoding="utf-8")
        except OSError as error:
            rule = "a JSON file with the settings of this step is needed"
            raise InputError(settings, "", "no readable file", rule, error.strerror or "") from error
    try:
        content = json.loads(text)
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise InputError(source, place, text, "this must be JSON", error.msg) from error
    return validate(model, content, source)


def every_nth(part: str) -> slice:
    """Which of many things a part like "0/4" takes: the first of four and every fourth after it. Raises InputError:
    no part."""
    number, _, parts = part.partition("/")
    if not (number.isdecimal() and parts.isdecimal() and int(number) < int(parts)):
        raise InputError("--part", "", part, "a number from 0, a slash and how many parts there are: 0/4 ... 3/4")
    return slice(int(number), None, int(parts))


def worlds_in(folder: Path) -> list[Path]:
    """The worlds of a folder, each a folder. Raises InputError: there is no such folder."""
    return sorted(path for path in folder_of(folder, "worlds").iterdir() if path.is_dir() and path.name[0] != ".")


def read_seed(path: Path) -> dict[str, Any]:
    """The seed of a proof: proof_seed, and whether it was drawn. Raises InputError: `armscope proof seed` has not
    written it."""
    from armscope.core.files import read_json

    content = read_json(path, "the file of `armscope proof seed`")
    if not isinstance(content, dict) or not {"proof_seed", "drawn"} <= set(content):
        raise InputError(path, "", "no proof_seed", "`armscope proof seed` writes this file")
    return content


def tell(line: str) -> None:
    """A line of progress, in the log of a step as it runs."""
    print(line, flush=True)


def read_measurements(poses: Path, *errors: Path) -> Measurements:
    """The measurements of a study; several tables of errors follow each other."""
    from armscope.core.files import read_table
    from armscope.paper.measurements import Measurements
    from armscope.recordings.columns import AXES_MM, ERROR_COLUMNS

    at = read_table(poses, ["trajectory", "point", "q1_rad", *AXES_MM], "the table poses.csv of a study")
    left = read_tables(errors, ["robot", "trajectory", "point", *ERROR_COLUMNS], "the table errors.csv of a study")
    robots = left["robot"].nunique()
    if not len(at) or len(left) != robots * len(at):
        rule = f"it has one row for each of the {len(at)} rows of {poses} and each of its {robots} robots"
        raise InputError(errors[0], "", f"{len(left)} rows", rule, "Are both of the same study?")
    return Measurements.from_tables(at, left)


def read_tables(
    paths: Sequence[Path], columns: Sequence[str] = (), what: str = "a table of a study (CSV)"
) -> pd.DataFrame:
    """Tables of the same columns, one after the other.

    Args:
        paths: the files.
        columns: what each must have.
        what: what they are, for the error.

    Returns:
        One table.

    Raises:
        InputError: as `read_table`.
    """
    import pandas as pd

    from armscope.core.files import read_table

    return pd.concat([read_table(path, columns, what) for path in paths], ignore_index=True)


def read_residuals(paths: Sequence[Path]) -> pd.DataFrame:
    """Residuals of a study, of several files one after the other."""
    from armscope.paper.residuals import COLUMNS

    return read_tables(paths, COLUMNS, "the table residuals.csv of a study")


def write_fits(path: Path, fits: Sequence[SwarmFit]) -> None:
    """Fitted models as compressed JSON, the same bytes for the same fits."""
    from armscope.core.files import replacing

    content = json.dumps([fit.to_dict(history=True) for fit in fits]).encode()
    with replacing(path) as beside:
        # the histories hardly compress: the fastest level loses a tenth in size and is five times as fast
        beside.write_bytes(gzip.compress(content, compresslevel=1, mtime=0))


def read_fits(*paths: Path) -> list[SwarmFit]:
    """Fitted models that `write_fits` wrote, file by file."""
    from armscope.core.files import read_json
    from armscope.errormodels.fitted import SwarmFit

    fits = []
    for path in paths:
        try:
            fits += [SwarmFit.from_dict(content) for content in read_json(path, "the file fits.json.gz of a study")]
        except (KeyError, TypeError) as error:
            raise InputError(path, "", f"no {error}", "`armscope paper fit` writes the fits of a study") from error
    return fits


def model_named(name: str) -> ModelSpec:
    """A model by its name."""
    from armscope.core.inputs import nearest
    from armscope.errormodels.features import ModelSpec

    specs = [
        ModelSpec(f, n, s) for f in ("polynomial", "fourier") for n in range(1, 7) for s in ("cartesian", "angular")
    ]
    by_name = {spec.name: spec for spec in specs}
    if name not in by_name:
        raise InputError("--model", "", name, "no model of that name", nearest(name, by_name))
    return by_name[name]


def size_of(text: str) -> Literal["small", "full"]:
    """Which proof. Raises InputError: neither small nor full."""
    if text == "small":
        return "small"
    if text == "full":
        return "full"
    raise InputError("--size", "", text, "a proof is small or full", nearest(text, ("small", "full")))
