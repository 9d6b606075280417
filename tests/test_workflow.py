"""The workflow as its users use it: overrides, clear errors, and reruns of what a change touches, nothing else."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
import yaml
from tools import jobs as jobs_measured

from tests.campaign import workflow as campaign

ROOT = Path(__file__).parents[1]
TARGETS = ("paper/table2.csv", "paper/figures/fig06.png")


def snakemake(folder, *arguments, succeeds=True):
    """Run snakemake on a checkout's copy, as a user would; returns what it printed."""
    command = [sys.executable, "-m", "snakemake", *arguments, "-j2", "--nocolor", "--configfile", "config/small.yaml"]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env={**os.environ})
    assert (run.returncode == 0) == succeeds, run.stdout + run.stderr
    return run.stdout + run.stderr


def jobs(printed):
    """Names of the rules that a dry run would execute."""
    lines = printed.partition("Job stats:")[2].partition("total")[0].splitlines()
    return {line.split()[0] for line in lines if line.split() and line.split()[-1].isdigit()}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A copy of the workflow in which a part of the small run has been done."""
    folder = tmp_path_factory.mktemp("checkout")
    for name in ("config", "workflow", "profiles", "src"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "Snakefile", folder)
    made = ("results/small/paper", "results/small/settings", ".snakemake/metadata")
    if all((ROOT / name).is_dir() for name in made):
        # `make test` has just made them: what is out of date in a copy of them is made anew, as it would be there
        for name in made:
            shutil.copytree(ROOT / name, folder / name)
    snakemake(folder, *(f"results/small/{target}" for target in TARGETS))
    return folder


def planned(folder, *arguments):
    return jobs(snakemake(folder, "-n", *(f"results/small/{target}" for target in TARGETS), *arguments))


def test_a_finished_run_has_nothing_to_do(finished):
    assert planned(finished) == set()


@pytest.mark.long
def test_a_swarm_setting_refits_but_does_not_measure_again(finished):
    rerun = planned(finished, "--config", "paper={swarm: {iterations: 50}}")
    assert "measure" not in rerun
    assert {"fit", "residuals", "table2", "figure"} <= rerun


@pytest.mark.long
def test_a_deleted_figure_is_redrawn_without_refitting(finished):
    figure = finished / "results/small/paper/figures/fig06.png"
    before = figure.read_bytes()
    figure.unlink()
    done = snakemake(finished, *(f"results/small/{target}" for target in TARGETS))
    assert jobs(done) == {"figure"}
    assert figure.read_bytes() == before


@pytest.mark.parametrize(
    ("override", "expected"),
    [
        ("paper={swarm: {partcles: 5}}", "Did you mean 'particles'?"),
        pytest.param("paper={swarm: {particles: many}}", "paper.swarm.particles", marks=pytest.mark.long),
        pytest.param("seed=-3", "seed", marks=pytest.mark.long),
        ("fleet=nope.csv", "nope.csv: found no readable file"),
    ],
)
def test_a_wrong_override_is_one_clear_error(finished, override, expected):
    printed = snakemake(finished, "-n", "--config", override, succeeds=False)
    assert expected in printed
    assert "Traceback" not in printed
    assert "InputFunctionException" not in printed


def after(rules, follows):
    """All rules that need one of some rules, by whatever way."""
    found, waiting = set(), [later for rule in rules for later in follows.get(rule, ())]
    while waiting:
        if (rule := waiting.pop()) not in found:
            found.add(rule)
            waiting += follows.get(rule, ())
    return found


@pytest.fixture(scope="module")
def drawn(finished):
    """The rules and which follows which, of a workflow that has no recordings of real arms."""
    return snakemake(finished, "all", "--rulegraph", "dot", "--config", "recordings_dir=nowhere")


@pytest.mark.long
def test_a_real_arm_that_is_not_there_is_skipped_with_a_reason(drawn):
    assert "is not there" in drawn


@pytest.mark.parametrize("profile", ["slurm", "slurm-generic"])
def test_no_job_of_a_cluster_waits_for_itself(finished, drawn, profile):
    """A group is one job: what one of its rules needs from outside must not need another one of them."""
    names = dict(re.findall(r'(\d+)\[label = "(\w+)"', drawn))
    follows = {}
    for before, later in re.findall(r"(\d+) -> (\d+)", drawn):
        follows.setdefault(names[before], set()).add(names[later])
    asked = yaml.safe_load((finished / "profiles" / profile / "config.yaml").read_text())
    assert asked["cores"] == 1  # else a group asks for as many cores as it has jobs that do not wait for each other
    assert {"measure", "table2", "proof_score"} <= set(asked["groups"]) & set(names.values())
    for group in set(asked["groups"].values()):
        inside = {rule for rule, name in asked["groups"].items() if name == group}
        outside = after(inside, follows) - inside
        assert not after(outside, follows) & inside, group


@pytest.mark.parametrize("profile", ["slurm", "slurm-generic"])
def test_no_job_of_a_cluster_is_shorter_than_its_start(profile):
    """By the jobs that were measured: alone, together with what its group holds, or where Snakemake runs."""
    asked = yaml.safe_load((ROOT / "profiles" / profile / "config.yaml").read_text())
    local = re.search(r"localrules:\n((?:    \w+,\n)+)", (ROOT / "Snakefile").read_text())
    took = (
        pd.read_csv(jobs_measured.TABLE)
        .set_index("rule")["longest_s"]
        .drop(re.findall(r"\w+", local[1]), errors="ignore")
    )
    together = took.groupby(took.index.map(lambda rule: asked["groups"].get(rule, rule))).sum()
    for group, count in asked["group-components"].items():
        together[group] *= count
    grows = {"scored"}  # what scores three dozen worlds here scores thousands there
    assert set(together.index[together < jobs_measured.START_S]) <= grows


@pytest.mark.long
@pytest.mark.parametrize(
    ("table", "name"),
    # the campaign below has a third one, in a folder called four
    [("config/fleet.csv", "fleet"), pytest.param("here/fleet.csv", "here-fleet", marks=pytest.mark.long)],
)
def test_two_fleets_of_one_file_name_have_folders_of_their_own(finished, table, name):
    (finished / "here").mkdir(exist_ok=True)
    shutil.copy(ROOT / "config" / "fleet.csv", finished / "here")
    shutil.copytree(ROOT / "examples", finished / "examples", dirs_exist_ok=True)
    assert f"/fleet/{name}/report.html" in snakemake(finished, "-n", "fleet", "--config", f"fleet={table}")


def test_an_absent_table_costs_its_own_arm_only(finished):
    """It is left out of what the workflow waits for; the diagnosis of its arm says what was not found."""
    shutil.copytree(ROOT / "examples", finished / "examples", dirs_exist_ok=True)
    arms = (finished / "config" / "fleet.csv").read_text()
    (finished / "absent.csv").write_text(arms + "gone,six-axis,2026-04,nowhere/robot.yaml,nowhere/recordings.csv\n")
    assert "fleet_diagnose" in jobs(snakemake(finished, "-n", "fleet", "--config", "fleet=absent.csv"))


@pytest.mark.long
def test_the_campaign_asks_for_files_that_the_workflow_makes(finished):
    """It takes hours and is run by hand: a folder that is called otherwise must not end it midway."""
    table = finished / campaign.FLEET
    table.parent.mkdir(exist_ok=True)
    shutil.copy(ROOT / "config" / "fleet.csv", table)
    shutil.copytree(ROOT / "examples", finished / "examples", dirs_exist_ok=True)
    targets = {*campaign.SHORTER, *campaign.TARGETS}
    printed = snakemake(finished, "-n", *targets, "--config", f"fleet={campaign.FLEET}")
    assert all(target in printed for target in targets if not (finished / target).exists())


@pytest.fixture(scope="module")
def changed(finished):
    """What is said of a run in which a tolerance is another one, with its commands.

    Whoever asks for it stands last: whether paths are within reach is worked out anew for it, and again after it.
    """
    change = "paper={tolerances: {link_mm: {value: 2.0, source: assumed}}}"
    return snakemake(finished, "-n", "-p", *(f"results/small/{target}" for target in TARGETS), "--config", change)


@pytest.mark.long
def test_a_tolerance_measures_again(changed):
    assert {"measure", "fit"} <= jobs(changed)


def test_settings_travel_as_small_files(finished, changed):
    assert "--settings results/small/settings/fit.json" in changed
    assert "--settings '{" not in changed
    assert (finished / "results/small/settings/fit.json").is_file()
