"""mapping.yaml: a typed, declarative account of how somebody's raw files become a recordings table.

Columns are named as in the file's header, or counted from 1. Groups (`angles`, `position`, ...) may be stated once for
all runs and again for a run, where the run's own count.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Annotated, Literal, Self

import pydantic
from pydantic import Field

from armscope.core.inputs import Strict, nearest
from armscope.recordings.importing.formats import Column, Format, RowFilter, TextFormat, Time

AngleUnit = Literal["rad", "deg", "gon", "mrad"]
LengthUnit = Literal["mm", "m", "cm", "um", "in", "ft"]


class Angles(Strict):
    """Motor angles q1 ... qn."""

    columns: tuple[Column, ...] = Field(min_length=1)
    unit: AngleUnit


class Vector(Strict):
    """Three lengths along x, y, z: a position or its 1-sigma uncertainty."""

    columns: tuple[Column, Column, Column]
    unit: LengthUnit


class Reflectors(Strict):
    """Several points of one tool in each row: the name of every reflector, with its three columns along x, y, z."""

    targets: dict[str, tuple[Column, Column, Column]] = Field(min_length=2)
    unit: LengthUnit


class Orientation(Strict):
    """Measurement frame from tool frame, by one of four ways.

    ``quaternion`` with its ``order``; or ``euler``, three angles about the axes that ``sequence`` names: capitals (XYZ)
    turn about the moving axes one after the other (intrinsic), small letters (xyz) about the fixed axes (extrinsic);
    or ``rotation_vector``, the axis times the angle (as Universal Robots' controllers write it); or ``matrix``, nine
    numbers row by row.
    """

    quaternion: tuple[Column, Column, Column, Column] | None = None
    order: Literal["wxyz", "xyzw"] | None = None
    euler: tuple[Column, Column, Column] | None = None
    sequence: str | None = None
    rotation_vector: tuple[Column, Column, Column] | None = None
    unit: AngleUnit | None = None
    matrix: Annotated[tuple[Column, ...], Field(min_length=9, max_length=9)] | None = None

    @pydantic.model_validator(mode="after")
    def _one_way(self) -> Self:
        if sum(way is not None for way in (self.quaternion, self.euler, self.rotation_vector, self.matrix)) != 1:
            ways = "a `quaternion`, `euler` angles, a `rotation_vector` or a `matrix`"
            raise ValueError(f"an orientation is {ways}: one of the four")
        if (self.quaternion is not None) != (self.order is not None):
            raise ValueError("`order` (wxyz or xyzw) belongs to a `quaternion`, and a `quaternion` needs it")
        by_angles = self.euler is not None or self.rotation_vector is not None
        if (self.euler is not None) != (self.sequence is not None) or by_angles != (self.unit is not None):
            raise ValueError("`sequence` and `unit` belong to `euler` angles, which need both; a vector needs a `unit`")
        if self.sequence is not None and not re.fullmatch(r"(?!.*(.)\1)([xyz]{3}|[XYZ]{3})", self.sequence):
            raise ValueError("`sequence` is three axes such as XYZ (about moving axes) or xyz (about fixed axes)")
        return self

    @property
    def columns(self) -> tuple[Column, ...]:
        """Those that it is in."""
        return self.quaternion or self.euler or self.rotation_vector or self.matrix or ()


class Pose(Strict):
    """Position and orientation as a homogeneous matrix, row by row: 12 columns, or 16 with the row 0 0 0 1."""

    matrix: tuple[Column, ...]
    unit: LengthUnit

    @pydantic.field_validator("matrix")
    @classmethod
    def _twelve_or_sixteen(cls, value: tuple[Column, ...]) -> tuple[Column, ...]:
        if len(value) not in (12, 16):
            raise ValueError(f"a homogeneous matrix has 12 or 16 numbers, row by row, not {len(value)}")
        return value


class PerMotor(Strict):
    """One column per motor: joint torque in N m (positive along gravity's pull), or the side of approach (-1, +1)."""

    columns: tuple[Column, ...] = Field(min_length=1)


class Speeds(PerMotor):
    """Motor speeds."""

    unit: Literal["rad/s", "deg/s"]


class Scalar(Strict):
    """A number from a ``column``, or the same ``constant`` in every row."""

    column: Column | None = None
    constant: float | None = None

    @pydantic.model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.column is None) == (self.constant is None):
            raise ValueError("give a `column` or a `constant`, one of the two")
        return self


class Label(Strict):
    """A word from a ``column``, the same ``constant`` in every row, or a ``cycle`` that starts anew when it ends."""

    column: Column | None = None
    constant: str | None = None
    cycle: tuple[str, ...] | None = Field(default=None, min_length=2)

    @pydantic.model_validator(mode="after")
    def _one_way(self) -> Self:
        if sum(way is not None for way in (self.column, self.constant, self.cycle)) != 1:
            raise ValueError("give a `column`, a `constant` or a `cycle`, one of the three")
        return self


class RunColumn(Strict):
    """The ``column`` that says of which run a row is: several runs in one file."""

    column: Column


class Identity(Strict):
    """What names a configuration: a ``column``, or the ``row_of`` a file beside (by its ``name``)."""

    column: Column | None = None
    row_of: str | None = None

    @pydantic.model_validator(mode="after")
    def _one_way(self) -> Self:
        if (self.column is None) == (self.row_of is None):
            raise ValueError("give a `column` or `row_of`, one of the two; leave `id` out for the source's own rows")
        return self


class Groups(Strict):
    """Groups of columns, stated for all runs or for one."""

    def with_own(self, own: Self) -> Self:
        """These, except where ``own`` states a group."""
        stated = {name: getattr(own, name) for name in own.model_fields_set}
        return self.model_copy(update=stated)


class Columns(Groups):
    """Where the columns of the recordings table come from."""

    angles: Angles | None = None
    position: Vector | None = None
    reflectors: Reflectors | None = None
    orientation: Orientation | None = None
    pose: Pose | None = None
    torque: PerMotor | None = None
    speed: Speeds | None = None
    approach: PerMotor | None = None
    sigma: Vector | None = None
    time: Time | None = None
    temperature: Scalar | None = None
    payload: Scalar | None = None
    target: Label | None = None
    run: RunColumn | None = None
    id: Identity | None = None

    def measured(self) -> list[Column]:
        """The columns of which none can stand for two quantities: angles, points, orientation, torque and speed."""
        ways = [self.angles, self.position, self.torque, self.speed]
        found = [column for way in ways if way is not None for column in way.columns]
        found += self.pose.matrix if self.pose is not None else ()
        found += [column for point in self.reflectors.targets.values() for column in point] if self.reflectors else ()
        turned = self.orientation
        return [*found, *(turned.columns if turned is not None else ())]

    def check_beside(self, known: set[str], of_run: str) -> None:
        """Columns called "name:column" and ``row_of`` must name a file beside, where there are such files. Raises
        ValueError: no file beside has this name."""
        wanted = {column.partition(":")[0] for column in self.measured() if isinstance(column, str) and ":" in column}
        wanted = wanted if known else set()
        if self.id is not None and self.id.row_of is not None:
            wanted.add(self.id.row_of)
        for name in sorted(wanted - known):
            cure = nearest(name, known) if known else "The run has no `beside`."
            raise ValueError(f"no file beside is called {name!r}{of_run}. {cure}".rstrip("."))


class Beside(Strict):
    """A second file whose rows stand beside the first one's; its columns are called "name:column".

    ``repeat_each``: how many rows of the first file in turn belong to each of its rows.
    """

    file: str
    name: str = Field(pattern=r"^[A-Za-z_]\w*$")
    repeat_each: int = Field(default=1, ge=1)
    format: Format | None = None


class RunFiles(Strict):
    """One run: a raw file, by its name, and how it is read where that differs from the mapping's common part."""

    run: str
    file: str
    beside: tuple[Beside, ...] = ()
    format: Format | None = None
    rows: tuple[RowFilter, ...] | None = None

    @pydantic.field_validator("run", mode="before")
    @classmethod
    def _run_is_text(cls, value: object) -> object:
        return str(value) if isinstance(value, int | float) else value


class Run(RunFiles):
    """One run of a recordings table, with groups of its own."""

    columns: Columns = Columns()


def refuse_runs_of_one_name(runs: Sequence[RunFiles]) -> None:
    """Make sure that runs have different names. Raises ValueError: two have the same."""
    names = [run.run for run in runs]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ValueError(f"the run {twice!r} stands twice; join its files with `beside`, or name them differently")


class Mapping(Strict):
    """mapping.yaml as a whole. Without ``runs`` every raw file becomes a run, named by its stem."""

    description: str = ""
    format: Format = TextFormat()
    columns: Columns
    rows: tuple[RowFilter, ...] = ()
    runs: tuple[Run, ...] = ()

    @pydantic.model_validator(mode="after")
    def _complete(self) -> Self:
        for run in self.runs or (Run(run="", file=""),):
            self._check_run(self.columns.with_own(run.columns), run)
        self._check_motors()
        refuse_runs_of_one_name(self.runs)
        return self

    def _check_motors(self) -> None:
        angles = {run.run: self.columns.with_own(run.columns).angles for run in self.runs}
        motors = {run: len(found.columns) for run, found in angles.items() if found is not None}
        if len(set(motors.values())) > 1:
            counts = ", ".join(f"{run}: {count}" for run, count in motors.items())
            raise ValueError(f"every run has the same number of motor angles, not {counts}")

    @staticmethod
    def _check_run(columns: Columns, run: Run) -> None:
        of_run = f" (run {run.run!r})" if run.run else ""
        if columns.angles is None:
            raise ValueError(f"no column for the motor angles: `angles` is needed{of_run}")
        if sum(way is not None for way in (columns.position, columns.reflectors, columns.pose)) != 1:
            raise ValueError(f"measured points come from `position`, `reflectors` or `pose`: one of the three{of_run}")
        if columns.reflectors is not None and (columns.target is not None or columns.orientation is not None):
            raise ValueError(f"`reflectors` name their targets, and have no `orientation`: leave these out{of_run}")
        if columns.pose is not None and columns.orientation is not None:
            raise ValueError(f"`pose` brings its own orientation: leave out `orientation`{of_run}")
        for group in ("torque", "speed", "approach"):
            per_motor = getattr(columns, group)
            if per_motor is not None and len(per_motor.columns) != len(columns.angles.columns):
                raise ValueError(
                    f"`{group}` names {len(per_motor.columns)} columns for {len(columns.angles.columns)} motors{of_run}"
                )
        twice = next((column for column, count in Counter(columns.measured()).items() if count > 1), None)
        if twice is not None:
            raise ValueError(f"the column {twice!r} is one quantity, and stands in two places{of_run}")
        columns.check_beside({beside.name for beside in run.beside}, of_run)
