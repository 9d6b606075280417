"""Every reader of a user's file, with files to begin from; whatever it is given, it answers or raises InputError."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from armscope.compensation.black_box import load_error_model
from armscope.compensation.path import read_path
from armscope.compensation.physical import load_identified
from armscope.core.config import Config
from armscope.core.inputs import read_yaml, validate
from armscope.core.variants import read_variants
from armscope.fleet.members import read_fleet
from armscope.motion.predicting import predict_motions
from armscope.motion.verdict import read_motion_verdict
from armscope.physics.model import predict
from armscope.physics.model_file import load_model
from armscope.physics.registry import library
from armscope.poses.exciting.output import pairs_of
from armscope.real.reference import load_reference
from armscope.recordings import read_recordings
from armscope.recordings.importing.draft import draft_mapping
from armscope.recordings.importing.fetching import load_source
from armscope.recordings.importing.motions import load_any_mapping
from armscope.recordings.importing.tables import import_recordings
from armscope.recordings.motions import read_motions
from armscope.robot import chain, load_arm
from armscope.robot.arm_type import read_arm_type
from armscope.robot.dh_table import parse_dh_table
from armscope.robot.dynamics import load_moving_arm
from armscope.verdict.files import read_verdict

ROOT = Path(__file__).parents[2]
CORPUS = Path(__file__).parent / "corpus"
EXAMPLE = ROOT / "examples" / "five-effects"
URDF = ROOT / "tests" / "robot" / "torso_arm.urdf"
RAW, MAPPING = CORPUS / "raw" / "semicolons.csv", CORPUS / "raw" / "mapping.yaml"


@dataclass(frozen=True)
class Reader:
    """How a file is read, and files of its kind.

    Attributes:
        read: reads a file (and uses what was read, where that is what can go wrong).
        seeds: good files to begin from.
    """

    read: Callable[[Path], object]
    seeds: tuple[Path, ...]

    @property
    def suffix(self) -> str:
        """What its files' names end in."""
        return "".join(self.seeds[0].suffixes)


def _arm(path: Path) -> None:
    arm = load_arm(path)
    assert np.isfinite(chain(arm, np.zeros((1, arm.n_motors))).tool).all()


def _arm_of_urdf(path: Path) -> None:
    described = path.with_name("arm-of-urdf.yaml")
    described.write_text(f"name: arm\nurdf: {path.name}\ntip: flange\nhold_joints: {{torso_lift: 0.1}}\n")
    _arm(described)


def _predicted(path: Path) -> None:
    model = load_model(path)
    angles = np.linspace(-1, 1, 3 * model.arm.n_motors).reshape(3, -1)
    names = [*(f"q{m}_rad" for m in range(1, model.arm.n_motors + 1)), "time_s", "temperature_c", "payload_kg"]
    names += [
        f"{name}{m}{unit}" for name, unit in (("approach", ""), ("dq", "_rad_s")) for m in range(1, 1 + len(angles.T))
    ]
    table = path.with_name("poses.csv")
    rows = np.column_stack([angles, [[0, 21, 5]] * 3, np.ones_like(angles), angles])
    np.savetxt(table, rows, delimiter=",", header=",".join(names), comments="")
    assert np.isfinite(predict(model, read_recordings(table, model.arm.n_motors, measured=False))).all()


def _black_box(path: Path) -> None:
    model = load_error_model(path)
    angles = np.linspace(-1, 1, 3 * model.arm.n_motors).reshape(3, -1)
    model.as_measured(angles)
    model.domain.outside(np.zeros((1, len(model.domain.inputs))))


def _played(path: Path) -> None:
    motions = next(iter(_seeds("tests/fuzz/corpus/motions/*")))
    assert np.isfinite(predict_motions(path, motions)[0].filter(like="tau").to_numpy()).all()


def _converted(path: Path) -> None:
    import_recordings([path], MAPPING, path.with_name("out.csv"))


def _drafted(path: Path) -> None:
    mapping = path.with_name("drafted.yaml")
    mapping.write_text(draft_mapping(path), encoding="utf-8")
    import_recordings([path], mapping, path.with_name("out.csv"))


def _mapped(path: Path) -> None:
    load_any_mapping(path)
    import_recordings([RAW], path, path.with_name("out.csv"))


def _recordings(path: Path) -> None:
    read_recordings(path)


def _poses(path: Path) -> None:
    read_recordings(path, 6, measured=False)


def _path(path: Path) -> None:
    read_path(path, load_arm(EXAMPLE / "robot.yaml"))


def _config(path: Path) -> None:
    validate(Config, read_yaml(path), path)


def _seeds(*patterns: str) -> tuple[Path, ...]:
    found = tuple(path for pattern in patterns for path in sorted(ROOT.glob(pattern)))
    assert found, patterns
    return found


def _pairs(path: Path) -> None:
    pairs_of(path)
    read_motion_verdict(path)


def _moving_arm(path: Path) -> None:
    arm = load_moving_arm(path)
    still = np.zeros((1, arm.n_motors))
    assert np.isfinite(arm.torques(still, still, still, arm.inertial)).all()


def _first_urdf(path: Path) -> None:
    _arm(path)


def _pasted(path: Path) -> None:
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return  # standard input is decoded before it is read
    parse_dh_table(text, "arm")


def _type_of_arm(path: Path) -> None:
    arm = load_arm(EXAMPLE / "robot.yaml")
    library(
        replace(arm, type=read_arm_type(path, "six-axis")), read_recordings(EXAMPLE / "recordings.csv", arm.n_motors)
    )


READERS = {
    "robot.yaml": Reader(_arm, _seeds("config/robots/*.yaml", "examples/*/robot.yaml")),
    "urdf": Reader(_arm_of_urdf, (URDF,)),
    "urdf alone": Reader(_first_urdf, (URDF,)),
    "dh table": Reader(_pasted, _seeds("tests/fuzz/corpus/dh/*")),
    "foreign.csv": Reader(_drafted, (RAW, *_seeds("tests/fuzz/corpus/foreign/*"), EXAMPLE / "recordings.csv")),
    "recordings.csv": Reader(_recordings, _seeds("tests/fuzz/corpus/recordings/*")),
    "poses.csv": Reader(_poses, _seeds("tests/fuzz/corpus/path/*")),
    "path.csv": Reader(_path, _seeds("tests/fuzz/corpus/path/*")),
    "mapping.yaml": Reader(_mapped, _seeds("tests/fuzz/corpus/raw/*.yaml", "config/recordings/*/mapping.yaml")),
    "raw.csv": Reader(_converted, (RAW,)),
    "source.yaml": Reader(load_source, _seeds("config/recordings/*/source.yaml")),
    "reference.yaml": Reader(load_reference, _seeds("config/recordings/*/reference.yaml")),
    "model.yaml": Reader(_predicted, _seeds("tests/fuzz/corpus/model/*")),
    "domain.json": Reader(load_identified, _seeds("tests/fuzz/corpus/domain/*")),
    "errormodel.json": Reader(_black_box, _seeds("tests/fuzz/corpus/errormodel/*")),
    "motions.csv": Reader(read_motions, _seeds("tests/fuzz/corpus/motions/*")),
    "motion model.yaml": Reader(_played, _seeds("tests/fuzz/corpus/motion-model/*")),
    "fleet.csv": Reader(read_fleet, _seeds("tests/fuzz/corpus/fleet/*")),
    "motion mapping.yaml": Reader(load_any_mapping, _seeds("config/motions/*/mapping.yaml")),
    "motion verdict.json": Reader(_pairs, _seeds("tests/fuzz/corpus/motion-verdict/*")),
    "moving robot.yaml": Reader(_moving_arm, _seeds("config/motion/*.yaml", "examples/moving-arm/robot.yaml")),
    "verdict.json": Reader(read_verdict, _seeds("tests/fuzz/corpus/verdict/*")),
    "priors.yaml": Reader(_type_of_arm, _seeds("tests/fuzz/corpus/priors/*")),
    "sweep.csv": Reader(read_variants, _seeds("config/sweeps/*")),
    "config.yaml": Reader(_config, _seeds("config/*.yaml")),
}
