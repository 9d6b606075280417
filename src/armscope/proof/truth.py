"""The sealed truth of worlds, as scoring reads it: archives with a truth.yaml and a test.csv per world."""

from __future__ import annotations

import gzip
import io
import tarfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from armscope.core.files import replacing
from armscope.core.inputs import InputError
from armscope.proof.definitions import TELLABLE_NATS, Name


@dataclass(frozen=True)
class Concealed:
    """One concealed effect."""

    # effect, location: its name; `unknown` if no library has it
    effect: str
    location: str
    driver: str
    minor: bool  # part of a real arm's background
    strength: float  # RMS at the tool in multiples of the noise
    parameters: dict[str, tuple[float, str]]  # (value, unit) by name, file units
    comparable: bool  # whether the fitted numbers can be compared with them
    # noncentrality, columns, frame_numbers: of the oracle's test; NaN and 0 for the background
    noncentrality: float
    columns: int
    frame_numbers: int
    alternatives: tuple[Name, ...]  # names that are as good in these poses
    shape: str = ""  # kind of an effect outside the library
    # of a rough arm's cause, how surely the oracle can say that it is there; NaN of others, and where a column that it
    # follows is not in the table
    oracle_nats: float = float("nan")

    @property
    def name(self) -> Name:
        """(effect, location)."""
        return self.effect, self.location

    @property
    def tellable(self) -> bool:
        """Whether the oracle itself has evidence for it, so far as that is known."""
        return not self.oracle_nats < TELLABLE_NATS


@dataclass(frozen=True, eq=False)
class Truth:
    """What a world conceals and how it came about; ``test`` holds the readings that nobody has seen.

    Of rough arms: ``rough`` says what is everywhere in it, ``also_allowed`` which names aren't wrong besides those of
    the effects, ``left_mm`` what frames and D-H values leave of the recorded rows, ``oracle_mm`` the held-out RMS of
    one who knows what there is.
    """

    world: str
    category: str
    arm: str
    fresh: bool
    rows: int
    sigma_mm: float
    noise_rms_mm: float
    noise: str
    masses: str
    left_out: tuple[str, ...]
    outside: bool
    true_rms_mm: float
    effects: tuple[Concealed, ...]
    test: pd.DataFrame
    rough: tuple[str, ...] = ()
    also_allowed: tuple[Name, ...] = ()
    left_mm: float = 0.0
    oracle_mm: float = float("nan")

    @property
    def story(self) -> list[Concealed]:
        """The concealed effects without a real arm's background."""
        return [effect for effect in self.effects if not effect.minor]


def seal(folder: Path, archive: Path) -> None:
    """Put every world's sealed files of ``folder`` (world/sealed/...) into one archive; same files, same bytes."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w") as tar:
        for file in sorted(folder.glob("*/sealed/*")):
            entry = tarfile.TarInfo(f"{file.parent.parent.name}/{file.name}")
            content = file.read_bytes()
            entry.size = len(content)
            tar.addfile(entry, io.BytesIO(content))
    with replacing(archive) as beside:
        beside.write_bytes(gzip.compress(packed.getvalue(), mtime=0))


def unseal(archive: Path) -> dict[str, Truth]:
    """The truths of an archive, by world. Raises InputError: it holds something else."""
    return {world: _truth(world, content, test) for world, (content, test) in unsealed(archive).items()}


def unsealed(archive: Path) -> dict[str, tuple[dict[str, Any], pd.DataFrame]]:
    """What an archive holds: truth.yaml and test.csv by world. Raises InputError: it holds something else."""
    found: dict[str, dict[str, bytes]] = {}
    with tarfile.open(archive) as tar:
        for entry in tar.getmembers():
            world, _, name = entry.name.partition("/")
            stream = tar.extractfile(entry)
            if stream is not None:
                found.setdefault(world, {})[name] = stream.read()
    for world, files in found.items():
        if set(files) != {"truth.yaml", "test.csv"}:
            raise InputError(archive, world, sorted(files), "a sealed world is a truth.yaml and a test.csv")
    return {
        world: (yaml.safe_load(files["truth.yaml"]), pd.read_csv(io.BytesIO(files["test.csv"])))
        for world, files in found.items()
    }


def _truth(world: str, content: dict[str, Any], test: pd.DataFrame) -> Truth:
    about = content["scoring"]
    return Truth(
        world=world,
        category=about["category"],
        arm=about["arm"],
        fresh=about["fresh"],
        rows=about["rows"],
        sigma_mm=content["sigma_mm"],
        noise_rms_mm=about["noise_rms_mm"],
        noise=about["noise"],
        masses=about["masses"],
        left_out=tuple(about["columns_left_out"]),
        outside=about["outside_library"],
        true_rms_mm=content["rms_on_test_mm"]["true_model"],
        effects=tuple(concealed(effect) for effect in content["effects"]),
        test=test,
        rough=tuple(about.get("rough", ())),
        also_allowed=tuple((effect, location) for effect, location in about.get("also_allowed", ())),
        left_mm=about.get("left_mm", 0.0),
        oracle_mm=about.get("oracle_on_test_mm", float("nan")),
    )


def concealed(content: dict[str, Any]) -> Concealed:
    """One concealed effect of a truth.yaml."""
    oracle = content.get("oracle", {"noncentrality": float("nan"), "columns": 0, "frame_numbers": 0})
    return Concealed(
        effect=content["effect"],
        location=content["location"],
        driver=content["driver"],
        minor=content.get("minor", False),
        strength=content["strength"],
        parameters={p["name"]: (p["value"], p["unit"]) for p in content["parameters"]},
        comparable=content.get("values_comparable", True),
        noncentrality=oracle["noncentrality"],
        columns=oracle["columns"],
        frame_numbers=oracle["frame_numbers"],
        alternatives=tuple((a["effect"], a["location"]) for a in content.get("alternatives", ())),
        shape=content.get("shape", ""),
        oracle_nats=content.get("oracle_nats", float("nan")),
    )
