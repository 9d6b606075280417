"""The documentation's site works from files: nothing of it comes from a network, and its search finds something."""

import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
WORKER = "iframe-worker"
"""Without it no browser searches in pages that are opened as files."""


def test_what_searches_in_files_lies_beside_the_pages() -> None:
    """The plugin for offline sites takes it from a network unless one of this name is given."""
    plain = re.sub(r"!!python/\S+", "", (ROOT / "mkdocs.yml").read_text(encoding="utf-8"))
    site = yaml.safe_load(plain)
    given = [*site["extra"]["polyfills"], *site["extra_css"], *site.get("extra_javascript", [])]
    assert [name for name in site["extra"]["polyfills"] if WORKER in name]
    for name in given:
        assert (ROOT / "docs" / name).is_file(), name
    text = (ROOT / "docs" / "javascripts" / f"{WORKER}.js").read_text(encoding="utf-8")
    assert "window.IFrameWorker" in text
    assert "Permission is hereby granted" in text


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site as `make docs` makes it."""
    mkdocs = shutil.which("mkdocs", path=str(ROOT / ".venv-docs" / "bin")) or shutil.which("mkdocs")
    if mkdocs is None:
        pytest.skip("mkdocs is not installed: `make docs` installs it")
    made = tmp_path_factory.mktemp("site")
    subprocess.run([mkdocs, "build", "--quiet", "-d", str(made)], cwd=ROOT, check=True, capture_output=True)
    return made


@pytest.mark.long
def test_no_page_loads_anything_from_a_network(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 20
    for page in pages:
        text = page.read_text(encoding="utf-8")
        loaded = re.findall(r"<(?:script|img|iframe|source)\b[^>]*\bsrc=[\"']?(\S+?)[\"'\s>]", text)
        loaded += re.findall(
            r"<link\b[^>]*rel=[\"']?(?:stylesheet|icon|preconnect)[^>]*href=[\"']?(\S+?)[\"'\s>]", text
        )
        assert loaded, page
        assert not [each for each in loaded if re.match(r"(https?:)?//", each)], page


@pytest.mark.long
@pytest.mark.parametrize("page", ["index.html", "reference/robot-yaml.html"])
def test_the_search_finds_something_in_pages_opened_as_files(site: Path, page: str) -> None:
    chromium = shutil.which("chromium")
    if chromium is None:
        pytest.skip("chromium is not installed")
    with tempfile.TemporaryDirectory() as home:
        words = [chromium, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={home}"]
        words += ["--virtual-time-budget=8000", "--dump-dom", f"file://{site / page}?q=backlash"]
        shown = subprocess.run(words, capture_output=True, text=True, check=True, timeout=120).stdout
    assert re.search(r"[1-9]\d* matching documents", shown)
