"""Tests stand where the code stands.

A module has a test file of its own name in the folder that mirrors its own, or a test file of its room takes from it.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE, TESTS = ROOT / "src" / "armscope", ROOT / "tests"
WITHOUT_CODE = "constants.py"
"""Tables of numbers: tests/house/test_constants.py asks of each what there is to ask."""
ELSEWHERE = {"campaign", "fuzz", "golden", "house"}
"""Folders of tests of no room."""
STILL_FROM_ELSEWHERE = [
    "__main__.py",
    "calibration/plausibility.py",
    "compensation/file_contents.py",
    "compensation/output.py",
    "compensation/result.py",
    "core/plainyaml.py",
    "core/records.py",
    "core/types.py",
    "diagnosis/row_noise.py",
    "diagnosis/scans/change_points.py",
    "diagnosis/scans/gear_mesh.py",
    "diagnosis/scans/pauses.py",
    "diagnosis/state.py",
    "diagnosis/summary/attribution_map.py",
    "diagnosis/summary/homogeneity.py",
    "diagnosis/summary/next_poses.py",
    "fitting/column_blocks.py",
    "fitting/joint_scatter.py",
    "measurement/robust.py",
    "measurement/whitening.py",
    "paper/bands.py",
    "paper/claims/catalogue.py",
    "paper/closed_loop.py",
    "paper/evidence.py",
    "paper/full_pose.py",
    "physics/clause.py",
    "physics/freeform.py",
    "physics/instrument.py",
    "physics/model_check.py",
    "physics/placing.py",
    "poses/output.py",
    "recordings/importing/conversion.py",
    "recordings/importing/pieces.py",
    "recordings/opening.py",
    "recordings/orientations.py",
    "report/figures/arm_labels.py",
    "report/figures/compliances.py",
    "report/figures/convergence.py",
    "report/figures/learned_curves.py",
    "report/figures/paper_arm.py",
    "report/figures/pose_choice.py",
    "report/figures/protocol.py",
    "report/figures/sweep.py",
    "report/figures/why.py",
    "report/pages/paper.py",
    "report/pages/paper_claims.py",
    "report/pages/paper_tables.py",
    "report/sections/along_joints.py",
    "report/sections/atlas.py",
    "report/sections/validation.py",
    "report/sections/cures.py",
    "report/sections/effects.py",
    "report/sections/unexplained.py",
    "report/sections/next_poses.py",
    "report/sections/suspect_rows.py",
    "report/sections/glossary.py",
    "report/sections/locations.py",
    "report/sections/work_order.py",
    "report/text/compliances.py",
    "swarm/kernel_data.py",
    "world/effect_placement.py",
]
"""Tested by what calls them only. The list only gets shorter."""


def modules() -> list[Path]:
    """All modules, relative to the package."""
    return sorted(path.relative_to(PACKAGE) for path in PACKAGE.rglob("*.py") if path.name != "__init__.py")


def taken(test: Path) -> Iterator[Path]:
    """Modules that a test file takes from, by name or by way of their package."""
    for node in ast.walk(ast.parse(test.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("armscope"):
            yield from _resolved(str(node.module), [each.name for each in node.names])


def _resolved(module: str, names: list[str]) -> Iterator[Path]:
    home = PACKAGE.joinpath(*module.split(".")[1:])
    if home.with_suffix(".py").exists():
        yield home.with_suffix(".py").relative_to(PACKAGE)
        return
    passed_on = [
        (str(node.module), {each.name for each in node.names})
        for node in ast.walk(ast.parse((home / "__init__.py").read_text(encoding="utf-8")))
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("armscope")
    ]
    for name in names:
        if (home / f"{name}.py").exists():
            yield (home / f"{name}.py").relative_to(PACKAGE)
        for origin, given in passed_on:
            if name in given and origin != module:
                yield from _resolved(origin, [name])


def untested_at_home() -> set[str]:
    """Modules without a test in their own room's folder; commands are tested in the rooms that they call."""
    by_room = {
        room.name: {module for test in (TESTS / room.name).rglob("*.py") for module in taken(test)}
        for room in PACKAGE.iterdir()
        if room.is_dir()
    }
    return {
        str(module)
        for module in modules()
        if module.parts[0] != "cli"
        and module.name != WITHOUT_CODE
        and not (TESTS / module.parent / f"test_{module.name}").exists()
        and module not in by_room.get(module.parts[0], set())
    }


def test_every_module_has_a_test_in_its_room() -> None:
    assert not untested_at_home() - set(STILL_FROM_ELSEWHERE)


def test_every_folder_of_tests_is_a_room() -> None:
    rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")} | ELSEWHERE
    assert {path.name for path in TESTS.iterdir() if path.is_dir() and path.name != "__pycache__"} <= rooms
