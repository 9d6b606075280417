"""The page and its figures, from tables of worlds of every kind of ending."""

import re

import numpy as np
import pytest

from armscope.core.files import write_table
from armscope.proof.rates import tables
from armscope.proof.scoring import score
from armscope.report.figures.proof import draw_all
from armscope.report.pages.proof import write_proof_page
from armscope.report.style import save_figure
from tests.proof.cases import claim, concealed, world


def worlds(count):
    """Clean, single, multiple, outside and failed worlds in turn."""
    rng = np.random.default_rng(2)
    offset, ratio, bump = (
        concealed("joint_offset", "joint 2"),
        concealed("gear_ratio", "joint 3"),
        concealed("unknown", "joint 2"),
    )
    endings = (
        {"category": "clean"},
        {"effects": [offset], "claims": [claim("joint_offset", "joint 2")]},
        {"effects": [offset], "claims": [claim("backlash", "joint 5")]},
        {"effects": [offset, ratio], "claims": [claim("gear_ratio", "joint 3")], "category": "multiple"},
        {"effects": [bump], "claims": [claim("unknown", "joint 2")], "category": "outside"},
        {"effects": [bump], "failed": "ValueError: it broke", "category": "outside"},
    )
    for number in range(count):
        ending = endings[number % len(endings)]
        yield world(**ending, fresh=number % 2 == 0, name=f"world-{number:03d}", off=float(rng.uniform(0.4, 0.6)))


@pytest.mark.parametrize(
    "count",
    # of a dozen in the quick run, with names that are hostile: tests/report/test_hostile_proofs.py
    [1, pytest.param(36, marks=pytest.mark.long)],
)
def test_every_figure_and_the_page_can_be_made(count, tmp_path):
    for name, table in tables(score(worlds(count))).items():
        write_table(tmp_path / f"{name}.csv", table)
    drawn = draw_all(tmp_path)
    for name, figure in drawn.items():
        save_figure(figure, tmp_path / name, formats=("svg",))
    write_proof_page(tmp_path / "report.html", tmp_path, tmp_path, {"proof_seed": 7, "drawn": True}, "small")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/svg+xml") == len(drawn)
    assert "too few cases" in page
    assert ("it broke" in page) == (count > 1)
    assert 'src="http' not in page
    heads = re.findall(r"<th[^>]*>([^<]*)</th>", page)
    assert "exact, minor names aside" in heads
    assert not [head for head in heads if "_" in head], "columns are called by words"
    nav = re.search(r"nav \{([^}]*)\}", page)
    assert nav
    assert "flex-wrap: wrap" in nav[1], "links without blanks between them break no line by themselves"
