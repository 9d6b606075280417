"""The command line: thin commands that read files, call the package and write files.

Each command imports what it needs when it runs, so that `armscope --help` and short jobs start quickly.
"""

from __future__ import annotations

import os
from typing import Annotated, Literal

import typer

from armscope.cli import (
    calibration,
    comparison,
    compensation,
    diagnosis,
    excite,
    fleet,
    init,
    outlook,
    paper,
    poses,
    proof,
    real,
    recordings,
    sweep,
)
from armscope.cli.commands import EXPERIMENTS
from armscope.cli.endings import endings

app = typer.Typer(
    name="armscope",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=True,
    context_settings={"help_option_names": ["--help", "-h"]},
)
app.add_typer(diagnosis.app)
app.add_typer(compensation.app)
app.add_typer(comparison.app)
app.add_typer(outlook.app)
app.add_typer(poses.app)
app.add_typer(excite.app)
app.add_typer(calibration.app)
app.add_typer(recordings.app)
app.add_typer(init.app)
app.add_typer(paper.app, name="paper", help="The 2006 paper, step by step.", rich_help_panel=EXPERIMENTS)
app.add_typer(
    proof.app,
    name="proof",
    help="The diagnosis on worlds with concealed effects, step by step.",
    rich_help_panel=EXPERIMENTS,
)
app.add_typer(real.app, name="real", help="Real arms in the reference protocol.", rich_help_panel=EXPERIMENTS)
app.add_typer(fleet.app, name="fleet", help="Many arms: one diagnosis each, and a page over all.")
app.add_typer(sweep.app, name="sweep", help="Variants of swarm and model.", rich_help_panel=EXPERIMENTS)


def _tell_version(wanted: bool) -> None:
    if wanted:
        import importlib.metadata

        print(f"armscope {importlib.metadata.version('armscope')}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", help="print the version", callback=_tell_version, is_eager=True)
    ] = False,
) -> None:
    """See where a robot arm misses its target, and why.

    Start with: armscope diagnose recordings.csv --robot robot.yaml -o out/
    """


@app.command("help", hidden=True)
def show_help(words: Annotated[list[str] | None, typer.Argument(help="a command")] = None) -> None:
    """What `armscope --help`, or that of a command, says: git and others answer to this word, too."""
    app([*(words or []), "--help"], prog_name="armscope")


@app.command("version", hidden=True)
def show_version() -> None:
    """What `armscope --version` says."""
    _tell_version(True)


@app.command("schema", rich_help_panel=EXPERIMENTS)
def print_schema(
    of: Annotated[
        Literal["config", "verdict", "model", "motion-verdict", "motion-model"], typer.Argument(help="the file")
    ] = "config",
) -> None:
    """Print the JSON schema of config.yaml, verdict.json or model.yaml (motion-...: of an arm in motion)."""
    import json

    from armscope.core import config
    from armscope.motion import contract as motion_contract
    from armscope.motion.model import file as motion_model_file
    from armscope.physics import model_file
    from armscope.verdict import contract

    schemas = {"config": config.schema, "verdict": contract.schema, "model": model_file.schema}
    schemas |= {"motion-verdict": motion_contract.schema, "motion-model": motion_model_file.schema}
    print(json.dumps(schemas[of](), indent=2))


def main() -> None:
    """Run the command line; whatever goes wrong ends it with one clear line and an exit code of its own."""
    # many small matrices: threads of BLAS would wait for each other and for other jobs; read when numpy is imported
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    with endings():
        app()
