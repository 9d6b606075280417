"""A built wheel by itself: in an empty environment outside the repository it diagnoses.

python -m tests.campaign.wheel [python3.11 python3.12 ...]
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.campaign.trial import ROOT, Outcome


def diagnoses(python: str) -> Outcome:
    """Build, install into a new environment with the pinned packages, diagnose an example from elsewhere.

    Args:
        python: which interpreter.
    """
    promise, tested = "the built wheel works without the repository", f"`armscope diagnose` from a wheel, {python}"
    if shutil.which(python) is None or subprocess.run([python, "-V"], capture_output=True, check=False).returncode:
        return Outcome(promise, tested, 0, (), f"{python} is not installed")
    with tempfile.TemporaryDirectory(prefix="wheel-") as made:
        home = Path(made)
        steps = [
            [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(home), str(ROOT)],
            [python, "-m", "venv", str(home / "venv")],
            [
                str(home / "venv/bin/pip"),
                "install",
                "--quiet",
                "--require-hashes",
                "-r",
                str(ROOT / "requirements.lock"),
            ],
        ]
        for step in steps:
            if (done := subprocess.run(step, cwd=home, capture_output=True, text=True, check=False)).returncode:
                return Outcome(promise, tested, 1, (f"{step[:4]}: {done.stderr[-500:]}",))
        wheel = next(home.glob("armscope-*.whl"))
        example = home / "example"
        shutil.copytree(ROOT / "examples" / "one-effect", example)
        install = [str(home / "venv/bin/pip"), "install", "--quiet", "--no-deps", str(wheel)]
        diagnose = [str(home / "venv/bin/armscope"), "diagnose", "recordings.csv", "--robot", "robot.yaml", "-o", "out"]
        for step in (install, diagnose):
            done = subprocess.run(
                step, cwd=example, env={"PATH": "/usr/bin:/bin"}, capture_output=True, text=True, check=False
            )
            if done.returncode:
                return Outcome(promise, tested, 1, (done.stderr[-500:],))
        whole = (example / "out" / "report.html").is_file()
        return Outcome(promise, tested, 1, () if whole else ("no report",))


if __name__ == "__main__":
    for name in sys.argv[1:] or ["python3"]:
        outcome = diagnoses(name)
        print(outcome.row(), *outcome.broken)
