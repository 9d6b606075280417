"""Nothing that a user has is overwritten, mixed or lost, and what a command writes appears together or not at all."""

import shutil

import pytest

from armscope.cli import app as armscope
from armscope.core.inputs import InputError
from tests.core.toy import EXAMPLE, ROOT, leftovers, refused, run, tree

# what is the user's


def aliases(path):
    """Other names of a file."""
    path.with_name("hard").hardlink_to(path)
    path.with_name("soft").symlink_to(path)
    path.with_name("sub").mkdir()
    return [path, path.with_name("hard"), path.with_name("soft"), path.with_name("sub") / ".." / path.name]


@pytest.mark.parametrize("force", [[], ["--force"]])
def test_an_input_is_never_overwritten_under_any_of_its_names(tmp_path, force):
    mine = tmp_path / "mine.csv"
    mine.write_text("mine")
    for name in aliases(mine):
        assert "an input of this command" in refused("file", "--source", mine, "-o", name, *force)
        assert "an input of this command" in refused("file", "--source", name, "-o", mine, *force)
        assert mine.read_text() == "mine"
    into = refused("folder", "--source", mine, "-o", tmp_path, "other", "mine.csv", *force)
    assert "an input of this command" in into
    assert not (tmp_path / "other").exists()
    assert leftovers(tmp_path) == []


@pytest.mark.parametrize(
    "line",
    [
        "predict OUT/robot.yaml OUT/recordings.csv -o OUT/recordings.csv",
        "predict OUT/robot.yaml OUT/recordings.csv -o OUT/robot.yaml",
        "calibrate OUT/recordings.csv -r OUT/robot.yaml -o OUT --splits 0",
        "diagnose OUT/predicted.csv -r OUT/robot.yaml -o OUT --no-report --resamples 0 --no-cross-validation",
        "fit-error-model OUT/recordings.csv -r OUT/robot.yaml -o OUT/recordings.csv",
        "import OUT/recordings.csv -m OUT/robot.yaml -o OUT/robot.yaml",
        "check OUT/recordings.csv -r OUT/robot.yaml --figure OUT/picture.png",
    ],
)
def test_no_command_overwrites_its_input_or_what_is_not_its_own(line, tmp_path):
    for name in ("robot.yaml", "recordings.csv"):
        shutil.copy(EXAMPLE / name, tmp_path / name)
    shutil.copy(EXAMPLE / "recordings.csv", tmp_path / "predicted.csv")
    (tmp_path / "picture.png").write_text("a picture of mine")
    before = tree(tmp_path)
    assert "an input of this" in (said := refused(*line.replace("OUT", str(tmp_path)).split(), app=armscope)) or (
        "picture.png" in said and "did not write" in said
    )
    assert tree(tmp_path) == before
    assert leftovers(tmp_path) == []


def test_a_file_that_a_description_names_is_an_input_too(tmp_path):
    arm = ROOT / "tests" / "robot" / "torso_arm.urdf"
    shutil.copy(arm, tmp_path / "arm.urdf")
    (tmp_path / "robot.yaml").write_text("name: an arm\nurdf: arm.urdf\ntip: nowhere\n")
    from armscope.core.outputs import Delivery
    from armscope.robot import load_arm

    with Delivery("any", [], [tmp_path / "out"]).running() as delivery:
        with pytest.raises(InputError):
            load_arm(tmp_path / "robot.yaml")
        for name in ("robot.yaml", "arm.urdf"):
            with pytest.raises(InputError, match="an input of this command"):
                delivery.stage(tmp_path / name)


def test_what_armscope_did_not_write_is_overwritten_only_when_forced(tmp_path):
    (tmp_path / "a").write_text("mine")
    assert "a file that armscope did not write" in refused("file", "-o", tmp_path / "a")
    assert "--force" in refused("folder", "-o", tmp_path, "b", "a")
    assert tree(tmp_path) == {"a": "mine"}
    assert run("file", "-o", tmp_path / "a", "--force").exit_code == 0
    assert tree(tmp_path) == {"a": "made"}
    (tmp_path / "c.json").write_text("mine")
    assert "c.json" in refused("file", "-o", tmp_path / "c.csv", "--beside")
    assert "c.csv" not in tree(tmp_path)  # both or none


def test_the_same_command_again_simply_works_and_a_file_that_was_edited_meanwhile_is_safe(tmp_path):
    for text in ("one", "two"):
        assert run("file", "-o", tmp_path / "a.csv", "--text", text, "--beside").exit_code == 0
        assert tree(tmp_path) == {"a.csv": text, "a.json": text}
    (tmp_path / "a.csv").write_text("edited")
    assert "changed since armscope wrote it" in refused("file", "-o", tmp_path / "a.csv")
    assert tree(tmp_path)["a.csv"] == "edited"


def test_another_commands_result_is_not_overwritten(tmp_path):
    assert run("folder", "-o", tmp_path / "out", "a").exit_code == 0
    assert "of another armscope result (folder)" in refused("file", "-o", tmp_path / "out" / "a")


def test_a_folder_holds_the_last_result_and_all_that_is_the_users(tmp_path):
    out = tmp_path / "new" / "out"
    assert run("folder", "-o", out, "a", "figures/b", "figures/c").exit_code == 0
    (out / "figures" / "mine").write_text("mine")
    (out / "a").write_text("edited, and not written again")
    assert run("folder", "-o", out, "figures/b", "d").exit_code == 2 or tree(out)["a"].startswith("edited")
    assert run("folder", "-o", out, "figures/b", "d", "--force").exit_code == 0
    assert tree(out) == {
        "a": "edited, and not written again", "d": "d ", "figures/b": "figures/b ", "figures/mine": "mine",
    }  # fmt: skip
    assert run("folder", "-o", out, "d").exit_code == 0
    assert sorted(tree(out)) == ["a", "d", "figures/mine"]
    assert leftovers(tmp_path) == []


def test_a_command_that_fails_leaves_everything_as_it_was(tmp_path):
    out = tmp_path / "out"
    assert run("folder", "-o", out, "a", "b", "--end", "error").exception
    assert list(tmp_path.iterdir()) == []
    assert run("folder", "-o", out, "a").exit_code == 0
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert run("folder", "-o", out, "a", "b", "--end", "error").exception
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_a_finding_is_no_failure(tmp_path):
    assert run("folder", "-o", tmp_path / "out", "a", "--end", "found").exit_code == 1
    assert tree(tmp_path) == {"out/a": "a "}


def test_every_path_a_command_takes_is_an_input_or_an_output_and_those_that_write_can_be_forced():
    import inspect

    commands = [command for group in [armscope, *(each.typer_instance for each in armscope.registered_groups)]
                for command in group.registered_commands]  # fmt: skip
    assert len(commands) > 10
    for each in commands:
        names = set(inspect.signature(each.callback).parameters)
        assert ("output" in names or "figure" in names or "visible" in names) == ("force" in names), each.callback


def test_an_output_by_a_link_that_leads_nowhere_says_which_link(tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "gone").symlink_to("nowhere-at-all/out")
    for place in ("loop", "loop/out"):
        told = refused("folder", "-o", tmp_path / place, "a")
        assert "is a link to loop, which leads to itself: remove it" in told
    assert {path.name for path in tmp_path.iterdir()} == {"loop", "gone"}
