"""Raw files and mappings that tests of the import make up, and their conversion."""

import pandas as pd
import yaml

from armscope.recordings.importing.tables import import_recordings

TEXT = ["id", "run", "target"]

SIMPLE = {
    "columns": {
        "angles": {"columns": ["j1", "j2"], "unit": "rad"},
        "position": {"columns": ["x", "y", "z"], "unit": "mm"},
    }
}


def convert(tmp_path, raw: str | dict[str, str], mapping: dict, output: str = "out.csv"):
    """Import text files with a mapping; the report and the table as text cells."""
    raw = {"raw.csv": raw} if isinstance(raw, str) else raw
    for name, text in raw.items():
        (tmp_path / name).write_bytes(text.encode())
    return convert_files(tmp_path, [tmp_path / name for name in raw], mapping, output)


def convert_files(tmp_path, paths, mapping, output="out.csv"):
    (tmp_path / "mapping.yaml").write_text(yaml.safe_dump(mapping))
    report = import_recordings(paths, tmp_path / "mapping.yaml", tmp_path / output)
    return report, pd.read_csv(tmp_path / output, dtype=dict.fromkeys(TEXT, str))


def with_format(**style):
    return {**SIMPLE, "format": style}


def with_columns(**groups):
    return {"columns": {**SIMPLE["columns"], **groups}}
