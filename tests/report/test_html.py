"""What a terminal shows in backticks is code on a page; scripts, styles and tags are what they are."""

from __future__ import annotations

import sys
from pathlib import Path

import jinja2
import pytest

from armscope.report.html import BesideTemplates, _as_code


def test_names_in_backticks_are_code_on_a_page() -> None:
    body = "<script>`a`</script><style>/* `b` */</style><p title='`c`'>see `armscope check`, a ` alone</p>"
    said = _as_code(body)
    assert "<script>`a`</script><style>/* `b` */</style><p title='`c`'>" in said
    assert "see <code>armscope check</code>, a ` alone" in said


def rendered(folder: Path) -> str:
    """What a new environment makes of page.html."""
    loader = jinja2.FileSystemLoader(folder)
    return jinja2.Environment(loader=loader, bytecode_cache=BesideTemplates(folder)).get_template("page.html").render()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with one template, where bytecode may be written beside it."""
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "pycache_prefix", None)
    (tmp_path / "page.html").write_text("{{ 1 + 1 }} axes")
    return tmp_path


def test_a_kept_template_is_not_compiled_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert rendered(folder) == "2 axes"
    assert len(list((folder / "__pycache__").iterdir())) == 1

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("compiled again")

    monkeypatch.setattr(jinja2.Environment, "compile", refuse)
    assert rendered(folder) == "2 axes"


def test_a_changed_template_and_a_broken_file_are_compiled_anew(folder: Path) -> None:
    rendered(folder)
    (folder / "page.html").write_text("{{ 2 + 1 }} axes")
    assert rendered(folder) == "3 axes"
    for kept in (folder / "__pycache__").iterdir():
        for broken in (b"", b"nonsense", kept.read_bytes()[:40], kept.read_bytes()[:-9]):
            kept.write_bytes(broken)
            assert rendered(folder) == "3 axes"


def test_nothing_is_kept_where_python_keeps_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert rendered(folder) == "2 axes"
    assert not (folder / "__pycache__").exists()


def test_a_folder_that_cannot_be_written_is_no_error(folder: Path) -> None:
    (folder / "__pycache__").write_text("a file in the folder's place")
    assert rendered(folder) == "2 axes"
