"""The audit's inequalities on numbers that are known to agree, or not to."""

import numpy as np
import pytest

from armscope.paper.audit import audit
from armscope.paper.audit import audit as audit_of_print
from armscope.paper.audit_scope import AuditScope
from armscope.paper.printed import predict_printed, printed_table2
from armscope.world.of_the_paper import archimedes_spiral

SMALL = AuditScope(corner_samples=256, rises=tuple(np.arange(-400.0, 401.0, 100.0)), search_generations=10)


@pytest.fixture(scope="module")
def table():
    return audit(SMALL)


@pytest.mark.long
def test_every_cell_of_the_printed_cartesian_models_is_audited(table):
    tests = table[table["trajectory"] != "identification"]
    assert len(tests) == 3 * 2 * (3 * 3 + 1)
    assert len(table) - len(tests) == 2 * 3 * 2
    assert (table["possible"] == (table["best_gap_mm"] == 0)).all()


def test_trajectory_two_contradicts_itself_under_either_reading(table):
    joint = table[(table["trajectory"] == "test 2") & (table["check"] == "all together")]
    assert not joint["possible"].any()
    assert joint["best_gap_mm"].min() > 1


def test_the_mean_reading_is_impossible_on_trajectory_one(table):
    """54 mm on average: no place within reach has such an error under Eqs. (15)-(17)."""
    row = table.query("trajectory == 'test 1' and reading == 'rms' and axis == 'x' and check == 'FDP(CI)'").iloc[0]
    assert not row["possible"]
    assert row["best_gap_mm"] > 30


def test_a_gap_by_hand(table):
    rows = "trajectory == 'test 2' and reading == 'rss' and axis == 'x' and check == 'FDP(CI)'"
    row = table.query(rows).iloc[0]
    rise = float(row["best_variant"].split()[1])
    size = np.linalg.norm(
        predict_printed("FDP(CI)", archimedes_spiral((1200, -600, 600), "xy", 20, 5, 200, rise))[:, 0]
    )
    assert row["best_value_mm"] == pytest.approx(size)
    assert row["best_gap_mm"] == pytest.approx(size - row["allowed_high_mm"])
    rounding = np.sqrt(200) * 5e-6 * (1 + 1200 + 600 + 600)  # about that much
    assert row["allowed_high_mm"] == pytest.approx(2.0 + 1.0 + 0.1 + rounding, abs=0.05)


@pytest.mark.long
def test_numbers_that_agree_are_not_accused(monkeypatch):
    """A table computed from the equations themselves on one of the scanned paths, with errors that are left."""
    import sys

    module = sys.modules["armscope.paper.audit"]
    assert callable(audit_of_print)
    rng = np.random.default_rng(0)
    table = printed_table2().set_index(["model", "trajectory", "axis"]).sort_index()
    for trajectory, plane, start in (
        ("test 2", "xy", SMALL.spiral_starts[0]),
        ("test 3", "yz", SMALL.spiral_starts[1]),
    ):
        path = archimedes_spiral(start, plane, 20, 5, 200, 200)
        measured = predict_printed("FDP(CI)", path) + 0.1 * rng.normal(size=(200, 3))
        for k, axis in enumerate("xyz"):
            norms = {"Uncompensated": measured[:, k]}
            norms |= {m: measured[:, k] - predict_printed(m, path)[:, k] for m in ("FDP(CI)", "SDP(CI)")}
            for model, values in norms.items():
                table.loc[(model, trajectory, axis), "printed"] = np.round(np.linalg.norm(values), 1)
    monkeypatch.setattr(module, "printed_table2", lambda: table.reset_index())
    scope = AuditScope(corner_samples=8, rises=(200.0,), search_generations=1)
    found = audit(scope).query("reading == 'rss' and trajectory in ['test 2', 'test 3']")
    assert found["possible"].all()
    assert set(found["best_variant"]) == {"rise 200 mm"}
