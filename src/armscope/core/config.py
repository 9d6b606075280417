"""config/config.yaml, typed: what the pipeline may be told, with the source of every number the paper lacks.

The JSON schema that Snakemake checks a configuration against is generated from these classes (`armscope schema`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any, Generic, Literal, TypeVar

import pydantic
from pydantic import AfterValidator, Field

from armscope.core.inputs import Strict

Value = TypeVar("Value")
Positive = Annotated[float, Field(gt=0)]
Count = Annotated[int, Field(ge=1)]
Point = tuple[float, float, float]


def _plain_path(path: str) -> str:
    if not re.fullmatch(r"[\w./+,@=-]+", path) or path.startswith("-"):
        rule = "a path of letters, digits and . / _ - + , @ = only, no spaces: it becomes part of shell commands"
        raise ValueError(f"{rule}. Choose another folder, or make a link to this one")
    return path


PlainPath = Annotated[str, AfterValidator(_plain_path)]
"""A file or folder that rules of the workflow name in their commands."""


class Stated(Strict, Generic[Value]):
    """A number together with where it comes from: a place in the paper, or ``assumed``."""

    value: Value
    source: str = Field(min_length=3, description="paper, page or equation; or `assumed`, and why this value")


class Tolerances(Strict):
    """One-sigma sizes of the geometric errors an arm of this kind has before calibration."""

    link_mm: Stated[Positive]
    link_mrad: Stated[Positive]
    base_mm: Stated[Positive]
    base_mrad: Stated[Positive]


class Ensemble(Strict):
    """How many further robots agree with the printed equations, and how many swarms fit each of them."""

    robots: Annotated[int, Field(ge=0)] = 100
    seeds: Count = 3


FEWEST_POSES = 48
"""The outlook's largest error model has 25 terms: 1.5 rows each must be left to it in every one of five folds."""


def _enough(poses: int) -> int:
    if poses < FEWEST_POSES:
        rule = (
            f"{FEWEST_POSES} or more: the largest error model has 25 terms, and a fifth of the rows is held out from it"
        )
        raise ValueError(f"{rule}. The paper has 85")
    return poses


class Identification(Strict):
    """The identification poses, and from how many possible ones they are chosen."""

    poses: Stated[Annotated[int, Field(json_schema_extra={"minimum": FEWEST_POSES}), AfterValidator(_enough)]]
    candidates: Stated[Count]
    margin_rad: Stated[Annotated[float, Field(ge=0)]]
    motor_6_rad: Stated[Positive]

    @pydantic.field_validator("candidates")
    @classmethod
    def _as_many_as_poses(cls, candidates: Stated[int], info: pydantic.ValidationInfo) -> Stated[int]:
        if "poses" in info.data and candidates.value < info.data["poses"].value:
            raise ValueError(f"at least as many as poses, {info.data['poses'].value}: each is used once")
        return candidates


class Trajectories(Strict):
    """The three test trajectories."""

    corners_mm: Stated[tuple[Point, Point, Point, Point]]
    points_per_side: Stated[Count]
    spiral_starts_mm: Stated[tuple[Point, Point]]
    spiral_enlargement: Stated[Positive]
    spiral_turns_pi: Stated[Positive]
    spiral_points: Stated[Count]
    third_coordinate_rise_mm: Stated[float]


class Tracker(Strict):
    """The laser tracker's errors, 1-sigma where the paper gives a +- bound."""

    accuracy_ppm: Stated[Annotated[float, Field(ge=0)]]
    repeatability_ppm: Stated[Annotated[float, Field(ge=0)]]
    resolution_um: Stated[Annotated[float, Field(ge=0)]]
    readings: Stated[Count]
    position_mm: Stated[Point]


class Swarm(Strict):
    """The particle swarms that fit the error models."""

    seeds: Count = 20
    particles: Annotated[int, Field(ge=2)] = 100
    iterations: Count = 200
    update: Literal["constriction", "inertia", "original"] = "constriction"
    neighbourhood: Literal["gbest", "ring"] = "gbest"
    velocity_clamp: Annotated[float, Field(gt=0)] | None = None
    threshold_mm: Annotated[float, Field(gt=0)] | None = None
    basis: Literal["raw", "standardised", "qr"] = "qr"
    layout: Literal["per axis", "joint"] = Field("per axis", description="one swarm per axis, or one for all axes")
    engine: Literal["auto", "numba", "numpy"] = "auto"


class Audit(Strict):
    """What the audit scans: where the arm's tool can be at all, and how far a third coordinate may rise."""

    box_low_mm: Stated[Point]
    box_high_mm: Stated[Point]
    largest_rise_mm: Stated[Positive]
    rise_step_mm: Stated[Positive]
    corner_samples: Stated[Count]


class Method(Strict):
    """The table of all bases, layouts and update rules: on how many robots, with how many swarms each."""

    robots: Count = 30
    seeds: Count = 1


class Sensitivity(Strict):
    """Other values of what is assumed, each tried by itself and all together."""

    robots: Count = Field(100, description="drawn in each scenario; fewer than 72 can't support a verdict")
    seeds: Count = Field(1, description="swarms for each fit")
    geometry: Stated[tuple[PlainPath, ...]] = Field(description="robot.yaml of other arms")
    tolerance_factors: Stated[tuple[Positive, ...]]
    margins_rad: Stated[tuple[Annotated[float, Field(ge=0)], ...]]
    motor_6_rad: Stated[tuple[Positive, ...]]
    corners_mm: Stated[tuple[tuple[Point, Point, Point, Point], ...]]
    rises_mm: Stated[tuple[float, ...]]
    repeats_mm: Stated[tuple[Positive, ...]] = Field(description="how well the arm repeats, 1-sigma per axis")
    together: Annotated[int, Field(ge=0)] = Field(4, description="scenarios of the joint, space-filling design")
    everything: bool = Field(False, description="also random search and cross-validated extensions: much slower")


class Model(Strict):
    """An error model: a family of functions of Cartesian or angular input, for each axis."""

    family: Literal["polynomial", "fourier"]
    order: Count = Field(description="degree of the polynomial, or number of harmonics")
    space: Literal["cartesian", "angular"]


class Paper(Strict):
    """The reproduction of the 2006 paper on a virtual arm."""

    robot: Stated[PlainPath]
    tolerances: Tolerances
    ensemble: Ensemble = Ensemble()
    identification: Identification
    trajectories: Trajectories
    tracker: Tracker
    audit: Audit
    sensitivity: Sensitivity
    method: Method = Method()
    models: tuple[Model, ...] = Field(min_length=1)
    swarm: Swarm = Swarm()


class RealSet(Strict):
    """Real recordings that the paper's models are fitted to; paths below ``recordings_dir``."""

    recordings: PlainPath
    robot: PlainPath
    run: str | None = None
    first_id: int | None = Field(None, description="leave out the rows of that run before this id")
    title: str
    reference: PlainPath | None = Field(None, description="reference.yaml: the protocol and figures of others")
    loads_recorded: bool = Field(False, description="torques or payloads were recorded, and can be withheld")
    diagnosed_splits: Count | None = Field(None, description="splits on which the diagnosis is repeated; null: all")
    oriented_splits: Count | None = Field(None, description="of these, repeated with orientations, too; null: all")


class Proof(Strict):
    """The diagnosis on worlds with concealed effects: how it is run there."""

    resamples: Annotated[int, Field(ge=0, description="how often rows are resampled; not scored")] = 0
    cross_validation: bool = Field(False, description="the proof scores rows that the diagnosis never saw instead")
    parts: Count = Field(4, description="jobs per half of the full proof's worlds")
    small: Count = Field(1, description="of the small proof's worlds every so many are made: 3 makes a third of them")


class PoseStudy(Strict):
    """Identification poses chosen for some arms, beside random ones and a grid."""

    robots: dict[str, PlainPath] = Field(description="robot.yaml by name")
    poses: Stated[Count]
    candidates: Stated[Count]
    seeds: Count = Field(200, description="arms with drawn errors, measured at each set of poses")
    tracker_mm: Stated[Point]
    floor_mm: Stated[float]


class ProofReal(Strict):
    """Known effects concealed in real recordings: which, how large, in which arms."""

    effects: tuple[str, ...] = (
        "backlash", "joint_compliance", "gear_mesh", "joint_coupling", "thermal_expansion", "base_shift",
        "instrument_scale",
    )  # fmt: skip
    sizes: tuple[Annotated[float, Field(gt=0)], ...] = Field(
        (0.5, 1.0, 3.0), description="RMS at the tool in multiples of what the arm's own diagnosis leaves"
    )
    most_rows: Count = Field(600, description="longer runs are thinned to this")
    sets: tuple[str, ...] | None = Field(None, description="real arms; null: all whose recordings are there")


class Config(Strict):
    """The whole configuration."""

    results: PlainPath = "results"
    seed: Annotated[int, Field(ge=0)] = 2006
    recordings_dir: PlainPath = "../shared/recordings"
    paper: Paper
    real: dict[str, RealSet] = Field(default_factory=dict)
    real_sets: tuple[str, ...] | None = Field(None, description="those of `real` that take part; null: all")
    sweep: PlainPath = "config/sweeps/default.csv"
    fleet: PlainPath = Field("config/fleet.csv", description="arms that `snakemake fleet` diagnoses")
    poses: PoseStudy
    proof: Proof = Proof()
    proof_real: ProofReal = ProofReal()
    bench_dir: PlainPath = Field("../shared/bench", description="developers' cases; skipped where they are not there")
    bench_parts: Count = Field(8, description="jobs that the bench's cases are diagnosed in")
    proof_seed: Annotated[int, Field(ge=0)] | None = Field(
        None, description="from which half of the proof's worlds are drawn; null: drawn when the proof runs"
    )


def schema() -> dict[str, Any]:
    """The JSON schema of config.yaml."""
    return Config.model_json_schema()


def stated_numbers(section: pydantic.BaseModel, prefix: str = "") -> list[dict[str, Any]]:
    """Every stated number below a section: rows of quantity, value, source."""
    rows: list[dict[str, Any]] = []
    for name in type(section).model_fields:
        value = getattr(section, name)
        if isinstance(value, Stated):
            rows.append({"quantity": prefix + name, "value": value.value, "source": value.source})
        elif isinstance(value, pydantic.BaseModel):
            rows += stated_numbers(value, f"{prefix}{name}.")
    return rows


def with_own_sources(config: Mapping[str, Any], default: Mapping[str, Any]) -> dict[str, Any]:
    """A configuration in which no number that was set anew keeps the source of the number that it stands in place of.

    Args:
        config: as it is used: the defaults, and over them what was set.
        default: of the file with all defaults; `{value: ..., source: ...}` is a number with its source.

    Returns:
        The configuration; a changed number that came without a source says so, and what the default was.
    """
    mended = dict(config)
    for name, part in config.items():
        was = default.get(name)
        if not (isinstance(part, Mapping) and isinstance(was, Mapping)):
            continue
        mended[name] = with_own_sources(part, was)
        own = {"value", "source"} <= part.keys() & was.keys() and part["value"] != was["value"]
        if own and part["source"] == was["source"]:
            mended[name]["source"] = f"set for this run, without a source (default: {was['value']}, {was['source']})"
    return mended
