"""The pages of the two proofs and the history of a comparison show names as they are, and obey none of them."""

import re
from base64 import b64decode
from dataclasses import replace

import pandas as pd
import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.files import write_table
from armscope.proof.rates import tables as rates_of_proof
from armscope.proof.scoring import score as score_of_proof
from armscope.real.rates import tables as rates_of_real
from armscope.real.scoring import score as score_of_real
from armscope.report.figures.proof import draw_all as draw_proof
from armscope.report.figures.real_proof import draw_all as draw_real
from armscope.report.pages.proof import write_proof_page
from armscope.report.pages.real_concealed import write_real_proof_page
from armscope.report.style import save_figure
from tests.proof.test_pages import worlds
from tests.real.test_scoring import altered, original, spring
from tests.report.test_hostile_names import EVIL, EXAMPLE, NAME, parsed


def obeys_nothing(html):
    """The page's parse, whose pictures are as harmless as itself."""
    page = parsed(html)
    assert page.handlers == page.scripts == []
    pictures = re.findall(r"data:image/svg\+xml;base64,([^\"]+)", html)
    for picture in pictures:
        drawn = parsed(b64decode(picture).decode())
        assert drawn.handlers == drawn.scripts == []
    return page, len(pictures)


def hostile(world, name):
    """A world of another name; where its diagnosis failed, the error says it, too."""
    truth, answer = replace(world.truth, world=name, arm=EVIL), replace(world.answer, world=name)
    return replace(world, truth=truth, answer=replace(answer, failed=answer.failed and f"ValueError: {EVIL}"))


@pytest.mark.long
def test_the_page_of_the_proof(tmp_path):
    made = [hostile(each, f"{EVIL}{n}") for n, each in enumerate(worlds(12))]
    for name, table in rates_of_proof(score_of_proof(made)).items():
        write_table(tmp_path / f"{name}.csv", table)
    drawn = draw_proof(tmp_path)
    for name, figure in drawn.items():
        save_figure(figure, tmp_path / name, formats=("svg",))
    write_proof_page(tmp_path / "report.html", tmp_path, tmp_path, {"proof_seed": 7, "drawn": True}, EVIL)
    page, pictures = obeys_nothing((tmp_path / "report.html").read_text())
    assert pictures == len(drawn) > 0
    assert "too few cases" in page.text
    assert f"ValueError: {EVIL}" in page.text
    assert page.text.count(EVIL) > len(made)


def test_the_page_of_known_effects_on_real_arms(tmp_path):
    sealed = [replace(each, set=EVIL) for each in (original(), altered(spring()), altered(spring(), part="fresh"))]
    tables, titles = rates_of_real(score_of_real(sealed)), {EVIL: f"title {EVIL}"}
    for name, figure in draw_real(tables, titles).items():
        save_figure(figure, tmp_path / name, formats=("png", "svg"))
    write_real_proof_page(tmp_path / "report.html", tables, tmp_path, {"proof_seed": 7, "drawn": True}, titles)
    page, pictures = obeys_nothing((tmp_path / "report.html").read_text())
    assert pictures > 0
    assert titles[EVIL] in page.text


@pytest.fixture
def compared(tmp_path):
    """What a comparison of files with hostile names writes and says."""
    table = pd.read_csv(EXAMPLE / "recordings.csv").head(80)
    files = [tmp_path / f"{NAME}{n}.csv" for n in "12"]
    table.to_csv(files[0], index=False)
    moved = table.assign(q2_rad=table["q2_rad"] + 0.01, x_mm=table["x_mm"] + 0.02)  # no number is measured twice
    moved.to_csv(files[1], index=False)
    line = ["compare", *files, "-r", EXAMPLE / "robot.yaml", "-o", tmp_path / "out"]
    done = CliRunner().invoke(app, [str(each) for each in line])
    assert done.exit_code == 0, done.exception
    return tmp_path / "out"


@pytest.mark.long
def test_the_history_of_a_comparison(compared):
    assert f"{NAME}2" in set(pd.read_csv(compared / "history.csv")["recording"])
    drawn = parsed((compared / "history.svg").read_text())
    assert drawn.handlers == drawn.scripts == []
