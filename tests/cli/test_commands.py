"""A folder of worlds is read, never written: no command takes it for an output of the same name."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from armscope.cli import app
from armscope.core.locks import Lock


@pytest.fixture
def worlds(tmp_path: Path) -> Path:
    (tmp_path / "worlds" / "some").mkdir(parents=True)
    (tmp_path / "worlds" / "some" / "robot.yaml").write_text("name: none\n")
    return tmp_path / "worlds"


@pytest.mark.parametrize("command", ["proof diagnose", "proof motion diagnose"])
def test_worlds_that_are_diagnosed_are_not_written(command: str, worlds: Path, monkeypatch) -> None:
    """Two commits can diagnose the same worlds side by side."""
    taken: list[str] = []
    monkeypatch.setattr(Lock, "take", lambda lock: taken.append(lock.what))
    monkeypatch.setattr("armscope.proof.diagnosing.diagnose_worlds", lambda *_: None)
    monkeypatch.setattr("armscope.proof.motion.diagnosing.diagnose_worlds", lambda *_: None)
    done = CliRunner().invoke(app, [*command.split(), str(worlds), "-o", str(worlds.parent / "verdicts")])
    assert done.exception is None or isinstance(done.exception, SystemExit)
    assert [what.split(":")[0] for what in taken] == [str(worlds.parent / "verdicts")]
