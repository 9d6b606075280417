"""Pages, hooks and the citation say what is there."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml
from tools import hygiene, lock

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").glob("*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    links = re.findall(r"\]\(([^)#]+)[^)]*\)|(?:src|href)=\"([^\"#]+)\"", page.read_text(encoding="utf-8"))
    for link in {one or other for one, other in links}:
        assert "://" in link or (page.parent / link).exists(), link
        if page.is_relative_to(ROOT / "docs") and "://" not in link:
            assert (page.parent / link).resolve().is_relative_to(ROOT / "docs"), f"{link} is not part of the site"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_tests_that_are_named_are_there(page: Path) -> None:
    for named in re.findall(r"\btests/[\w/]+\.py\b", page.read_text(encoding="utf-8")):
        assert (ROOT / named).is_file(), named


def test_the_citation_is_of_this_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == project["version"]
    assert citation["license"] == project["license"]
    assert citation["title"].startswith(f"{project['name']}:")


def test_hooks_are_local_and_run_what_is_pinned() -> None:
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"))["repos"]
    assert [each["repo"] for each in hooks] == ["local"]
    assert all(hook["language"] == "system" for hook in hooks[0]["hooks"])


@pytest.mark.parametrize("name", lock.LOCKS)
def test_locks_hold_what_is_pinned_with_hashes_and_name_no_index(name: str) -> None:
    """`python -m tools.lock` was run when a pin changed."""
    locked = (ROOT / f"{name}.lock").read_text(encoding="utf-8")
    known = lock.pins(locked) | lock.pins((ROOT / f"{lock.LOCKS[0]}.lock").read_text(encoding="utf-8"))
    assert lock.pins((ROOT / f"{name}.txt").read_text(encoding="utf-8")).items() <= known.items()
    assert all("--hash=sha256:" in entry for entry in re.split(r"\n(?=[^\s#-])", locked)[1:])
    assert "://" not in locked


def test_ends_are_mended_and_merges_noticed(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_bytes(b"one  \r\ntwo\n\n\n")
    assert hygiene.mend([file]) == [f"{file}: ends of lines or of the file, mended"]
    assert file.read_bytes() == b"one\ntwo\n"
    assert hygiene.mend([file]) == []
    file.write_bytes(b"<<<<<<< ours\n")
    assert hygiene.mend([file]) == [f"{file}: an unfinished merge"]
