"""The pages about the files' keys and columns, made from the typed models that read and write them.

python -m tools.reference           # writes docs/reference/*.md
python -m tools.reference --check   # fails where a page is not what the code is
"""

from __future__ import annotations

import inspect
import json
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from armscope.motion import contract as motion_contract
from armscope.motion import verdict as motion_verdict
from armscope.physics import model_file
from armscope.physics.model_contents import ModelFile
from armscope.recordings.columns import COLUMNS, Column
from armscope.recordings.constants import POSSIBLE
from armscope.robot.description import RobotDescription
from armscope.verdict import contract
from armscope.verdict import effects as verdict_effects
from armscope.verdict import schema as verdict_schema

TWINS: dict[str, type[Any]] = {
    "EffectFile": verdict_effects.FoundEffect,
    "HeldOutFile": verdict_schema.HeldOut,
    "OrientationFile": verdict_schema.Orientations,
    "VerdictFile": verdict_schema.Verdict,
}
"""What parts of verdict.json are in memory, where their attributes are explained."""

NOTHING = re.compile(r"\b(?:None|NaN)\b")
"""What stands in memory where a file has null."""

PAGES = Path(__file__).parents[1] / "docs" / "reference"
MADE = "Made from the code by `python -m tools.reference`."

ROBOT = """\
The nominal arm, as its data sheet says: D-H rows, or a URDF. `armscope init` writes one. Lengths are millimetres,
angles degrees, masses kilograms. An unknown key is an error that names the nearest known one. `--robot arm.urdf`
works without this file: the tip is then guessed, and said.

```yaml
name: UR5
dh:
  joints:
    - {a_mm: 0, alpha_deg: 90, d_mm: 89.159}
    - {a_mm: -425, alpha_deg: 0, d_mm: 0}
    # ... one row per joint, from the base
tool_mm: [0, 0, 150]
links:
  - {mass_kg: 3.7, com_mm: [0, -26, 1.9]}
    # ... one per row
```

**Frames.** D-H frame j is the one that row j leads to. With `convention: standard`, row j is Rz(theta) Tz(d) Tx(a)
Rx(alpha): its frame lies at the far end of link j and turns with joint j. With `modified` (Craig), row j is
Rx(alpha) Tx(a) Rz(theta) Tz(d): its frame lies on axis j and turns with joint j. `com_mm` is counted along the x,
y, z axes of frame j, the same frame in which a data sheet states it; `tool_mm` and the centre of mass of
`tool_load` along those of the last frame (of a URDF: of the frame `tip`). The base frame is frame 0 (of a URDF: its
root link); `gravity_m_s2` points down in it.

**Signs.** A joint turns positively about its z axis by the right hand. A load is positive along its pull: a
recorded torque `tau1_nm` that turns joint 1 positively if nothing held it is positive, and what gives way turns
with it (deflection = compliance x load). The torque of the motor that holds the joint is the opposite; `armscope
check` compares with gravity and says which a table holds.
"""

RECORDINGS = """\
One row per measured point, comma-separated, UTF-8, decimal points; `.gz` is read, too. Units stand in the names.
Small and capital letters are the same (`Q1_RAD` is read as `q1_rad`, and said). An empty cell is a value that was
not recorded. Further columns are kept and named in a note. Files in other shapes: `armscope import` with a mapping,
which `armscope init table.csv` drafts. Errors name the *line* of the file, whose header is line 1. What is found of a
*row* names its `id`; where there are none, rows are counted from 1 below the header.

```
q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad,x_mm,y_mm,z_mm,payload_kg
0.1,-1.2,1.4,-0.3,0.9,0.0,512.331,-40.127,610.884,2.5
```

Needed are the commanded angles of every motor and, except where positions are to be predicted, the measured point.
"""

VERDICT = """\
What `armscope diagnose` found, beside its report. Every key is always there; a number that is not known is `null`.
Keys of this version stay; more may come. `armscope.read_verdict(path)` reads it back. The JSON schema: `armscope
schema verdict`.
"""

MOTION_VERDICT = """\
What `armscope diagnose motions.csv` found, beside its report. Every key is always there; a number that is not known is
`null`. Torques are N m (N of a sliding joint), errors relative to the torque. Keys of this version stay; more may come.
The JSON schema: `armscope schema motion-verdict`.
"""

MODEL = """\
The fitted model: the robot as described, frames, and effects as terms that are linear in their values. `armscope
predict` and `compensate` read it. Values are SI units. The JSON schema: `armscope schema model`.
"""


def robot() -> str:
    """The page about robot.yaml."""
    return _page("robot.yaml", ROBOT, RobotDescription.model_json_schema(), RobotDescription)


def verdict() -> str:
    """The page about verdict.json."""
    return _page("verdict.json", VERDICT, contract.schema(), contract.VerdictFile)


def verdict_of_motion() -> str:
    """The page about verdict.json of a motion."""
    schema = motion_contract.schema()
    return _page("verdict.json of an arm in motion", MOTION_VERDICT, schema, motion_verdict.MotionVerdict)


def model() -> str:
    """The page about model.yaml; what its robot holds stands on a page of its own."""
    schema = model_file.schema()
    described = RobotDescription.model_json_schema()
    for name in ("RobotDescription", *described["$defs"]):
        schema["$defs"].pop(name, None)
    return _page("model.yaml", MODEL, schema, ModelFile)


def recordings() -> str:
    """The page about recordings.csv."""
    rows = ["| column | unit | meaning | allowed |", "|---|---|---|---|", *map(_column, COLUMNS)]
    return "\n".join([f"# recordings.csv\n\n{MADE}\n", RECORDINGS, *rows, ""])


def _column(column: Column) -> str:
    name = column.name.replace("{j}", "*j*") if "{j}" in column.name else f"`{column.name}`"
    bounded = max(abs(column.low), abs(column.high)) < POSSIBLE.number
    allowed = f"{column.low:.6g} to {column.high:.6g}: {column.rule}" if bounded else ""
    return f"| {name} | {column.unit} | {column.meaning.replace('{j}', '*j*')} | {allowed} |"


def _page(title: str, head: str, schema: dict[str, Any], main: type[Any]) -> str:
    parts = [f"# {title}\n\n{MADE}\n", head, "## Keys\n", *_table(schema, _told_of(main.__name__, main))]
    for name, part in sorted(schema.get("$defs", {}).items()):
        if "properties" in part:
            parts += [f"\n## {name}\n", f"{_first_paragraph(part)}\n", *_table(part, _told_of(name, main))]
    return "\n".join([*parts, ""])


def _told_of(name: str, main: type[Any]) -> dict[str, str]:
    """What a part of a file, and what it is in memory, say of its attributes."""
    return {**_told(TWINS.get(name)), **_told(_class_of(main, name))}


def _class_of(main: type[Any], name: str) -> type[Any] | None:
    homes = (sys.modules[main.__module__], motion_verdict, contract, verdict_schema, verdict_effects)
    return next((getattr(home, name) for home in homes if hasattr(home, name)), None)


def _first_paragraph(part: dict[str, Any]) -> str:
    return " ".join(str(part.get("description", "")).replace("``", "`").split("Attributes:")[0].split())


def _told(kind: type[Any] | None) -> dict[str, str]:
    """What a class says of its attributes: "one, other: meaning" under Attributes."""
    section = (inspect.getdoc(kind) or "").partition("Attributes:")[2] if kind is not None else ""
    entries = re.split(r"\n    (?=\S)", section)
    told: dict[str, str] = {}
    for entry in entries:
        names, colon, meaning = entry.partition(": ")
        if colon:
            told |= dict.fromkeys((name.strip() for name in names.split(",")), " ".join(meaning.split()))
    return told


def _table(schema: dict[str, Any], told: dict[str, str]) -> Iterator[str]:
    required = schema.get("required", [])
    yield "| key | value | default | meaning |"
    yield "|---|---|---|---|"
    for key, part in schema["properties"].items():
        always = key in required and "default" not in part
        default = "always there" if always else _default(part)
        meaning = " ".join(str(part.get("description") or told.get(key, "")).split())
        meaning = NOTHING.sub("`null`", meaning.replace("|", "\\|").replace("``", "`"))
        yield f"| `{key}` | {_kind(part if always else _without_null(part))} | {default} | {meaning} |"


def _without_null(part: dict[str, Any]) -> dict[str, Any]:
    """A key that may be left out is left out, not null."""
    kinds = [each for each in part.get("anyOf", ()) if each.get("type") != "null"]
    return {**part, "anyOf": kinds} if kinds else part


def _default(part: dict[str, Any]) -> str:
    value = part.get("default")
    return "" if value in (None, {}, []) else f"`{json.dumps(value)}`"


def _kind(part: dict[str, Any]) -> str:
    """What a value is, with its range, in words."""
    if "$ref" in part:
        name = part["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})" if name != "RobotDescription" else "[robot.yaml](robot-yaml.md)"
    if "anyOf" in part:
        return " or ".join(_kind(each) for each in part["anyOf"])
    if "enum" in part or "const" in part:
        return ", ".join(f"`{each}`" for each in part.get("enum", [part.get("const")]))
    if part.get("type") == "array":
        return _list_kind(part)
    if part.get("type") == "object":
        inner = part.get("additionalProperties")
        return f"by name: {_kind(inner)}" if isinstance(inner, dict) else "by name"
    words = {
        "number": "number",
        "integer": "whole number",
        "string": "text",
        "boolean": "true or false",
        "null": "null",
    }
    return words.get(str(part.get("type")), "anything") + _range(part)


def _list_kind(part: dict[str, Any]) -> str:
    if "prefixItems" in part:
        kinds = [_kind(each) for each in part["prefixItems"]]
        return f"{len(kinds)} x {kinds[0]}" if len(set(kinds)) == 1 else "[" + ", ".join(kinds) + "]"
    return f"list of {_kind(part.get('items', {}))}"


def _range(part: dict[str, Any]) -> str:
    low = part.get("minimum", part.get("exclusiveMinimum"))
    high = part.get("maximum", part.get("exclusiveMaximum"))
    if low is None and high is None:
        return ""
    above = "above " if "exclusiveMinimum" in part else ""
    if high is None:
        return f", {above}{low:g}" if above else f", {low:g} or more"
    return f", {above}{low:g} to {high:g}" if low is not None else f", up to {high:g}"


MAKERS: dict[str, Callable[[], str]] = {
    "robot-yaml.md": robot,
    "recordings-csv.md": recordings,
    "verdict-json.md": verdict,
    "motion-verdict-json.md": verdict_of_motion,
    "model-yaml.md": model,
}


def main() -> None:
    """Write the pages, or check those that are there."""
    if "--check" in sys.argv[1:]:
        stale = [name for name, make in MAKERS.items() if not _is(PAGES / name, make())]
        if stale:
            sys.exit(f"not what the code is: {', '.join(stale)}: python -m tools.reference")
        return
    PAGES.mkdir(parents=True, exist_ok=True)
    for name, make in MAKERS.items():
        (PAGES / name).write_text(make(), encoding="utf-8")


def _is(page: Path, text: str) -> bool:
    return page.exists() and page.read_text(encoding="utf-8") == text


if __name__ == "__main__":
    main()
