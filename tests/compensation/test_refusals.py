"""Every row that can't be served says why; whatever is served stays inside what was identified."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from armscope.compensation.compensate import compensate_black_box, compensate_physical
from armscope.compensation.path import as_path
from armscope.compensation.task import Options
from armscope.core.inputs import InputError
from armscope.robot import chain

from .arms import CONTEXT, MIDDLE, black_box, physical, physical_path, sk120, table_of, wanted_points


def reasons(table, options=None):
    model, identified = physical()
    _, middle = physical_path()
    return compensate_physical(
        model, identified, as_path(table, "path", model.arm), options or Options(start_rad=middle)
    ).reasons


def test_outside_the_identified_range_is_refused_and_the_distance_stated():
    wanted = wanted_points(3)
    wanted[1] = chain(sk120(), (MIDDLE + np.eye(6)[0])[None]).tool[0]
    result = compensate_black_box(
        black_box(), as_path(table_of(wanted), "path", sk120()), Options(separate_points=True)
    )
    assert result.reached.tolist() == [True, False, True]
    assert "outside the identified range" in result.reasons[1]
    assert result.outside[1] > 0.2
    assert f"{result.outside[1]:.2g} standard deviations" in result.reasons[1]
    allowed = compensate_black_box(
        black_box(), as_path(table_of(wanted), "path", sk120()), Options(separate_points=True, allowed_outside=10.0)
    )
    assert allowed.reached.all()


@pytest.mark.parametrize("column", ["payload_kg", "temperature_c"])
def test_missing_context_that_the_model_follows_is_said_per_row(column):
    points, _ = physical_path(10)
    table = table_of(points, **CONTEXT)
    assert set(reasons(table.drop(columns=column))) == {f"no {column}, which the model follows"}
    table.loc[4, column] = np.nan
    said = reasons(table)
    assert said[4] == f"no {column}, which the model follows"
    assert set(np.delete(said, 4)) == {""}


def test_points_that_lie_at_the_base_raise_the_question_of_units_whatever_refuses_them():
    """A folded arm may well reach 2 mm from its base: the range refuses it, and the unit is asked for all the same."""
    points, _ = physical_path(6)
    said = reasons(table_of(points * 1e-3, **CONTEXT))
    assert all("are they metres in columns called _mm?" in reason for reason in said)


def test_context_that_the_model_does_not_follow_is_not_asked_for():
    model, identified = physical()
    points, middle = physical_path(5)
    stiff = replace(model, parts=model.parts[:1])
    result = compensate_physical(
        stiff, identified, as_path(table_of(points), "path", model.arm), Options(start_rad=middle)
    )
    assert result.reached.all()


def test_a_load_outside_the_identified_ones_is_refused():
    points, _ = physical_path(4)
    said = reasons(table_of(points, payload_kg=60.0, temperature_c=24.0))
    assert all("payload_kg" in reason for reason in said)


def test_unknown_runs_and_targets_are_refused():
    points, _ = physical_path(4)
    table = table_of(points, **CONTEXT)
    assert reasons(table.assign(run=["monday", "monday", "tuesday", "monday"])).tolist() == [
        "", "", "run 'tuesday' is not in the model", "",
    ]  # fmt: skip
    assert reasons(table.assign(target="cube"))[0] == "target 'cube' is not in the model"


def test_limits_are_kept_and_named():
    arm = sk120()
    angles = np.tile(MIDDLE, (2, 1))
    angles[1, 0] = np.radians(151)
    table = pd.DataFrame(angles, columns=[f"q{j}_rad" for j in range(1, 7)])
    result = compensate_black_box(black_box(), as_path(table, "path", arm), Options(allowed_outside=100.0))
    assert result.reasons.tolist() == ["", "limit of joint 1"]


def test_a_command_never_leaves_the_limits():
    model, identified = physical()
    points, middle = physical_path(15)
    free = compensate_physical(
        model, identified, as_path(table_of(points, **CONTEXT), "p", model.arm), Options(start_rad=middle)
    )
    limits = np.column_stack([free.commands.min(axis=0) - 1, free.commands.max(axis=0) + 1])
    limits[3, 1] = np.median(free.commands[:, 3])  # within what the free commands use
    tight = replace(model, arm=replace(model.arm, limits=limits))
    result = compensate_physical(
        tight, identified, as_path(table_of(points, **CONTEXT), "p", model.arm), Options(start_rad=middle)
    )
    commands = result.commands[result.reached]
    assert len(commands)
    assert np.all(commands <= limits[:, 1] + 1e-12)
    assert np.abs(result.residual[result.reached]).max() < 2e-9


def test_the_pole_of_the_wrist_is_refused_in_full_pose():
    model, _ = physical()
    _, middle = physical_path()
    straight = middle.copy()
    straight[4] = wrist_pole(model.arm, middle)
    table = pd.DataFrame([middle, straight], columns=[f"q{j}_rad" for j in range(1, 7)]).assign(**CONTEXT)
    said = reasons(table, Options(pose=True, start_rad=middle, allowed_outside=5.0))
    assert said[0] == ""
    assert "pole" in said[1]


def wrist_pole(arm, middle):
    """The angle of motor 5 at which the axes of joints 4 and 6 are in line."""
    angles = np.linspace(-2, 2, 4001)
    frames = chain(arm, np.where(np.arange(6) == 4, angles[:, None], middle))
    axes = frames.joint_rotation[..., 2]
    return angles[np.argmax(np.abs(np.sum(axes[:, 3] * axes[:, 5], axis=1)))]


def test_a_turned_away_orientation_is_refused_not_approximated():
    model, _ = physical()
    points, middle = physical_path(3)
    turn = chain(model.arm, middle[None]).tool_rotation[0] @ Rotation.from_euler("y", 170, degrees=True).as_matrix()
    x, y, z, w = Rotation.from_matrix(turn).as_quat()
    said = reasons(table_of(points, qw=w, qx=x, qy=y, qz=z, **CONTEXT), Options(pose=True, start_rad=middle))
    assert (said != "").all()


def test_lengths_in_the_wrong_unit_are_doubted():
    wanted = wanted_points(4)
    metres = pd.DataFrame(wanted * 1e3, columns=["x_m", "y_m", "z_m"])
    said = compensate_black_box(black_box(), as_path(metres, "path", sk120())).reasons
    assert all("millimetres" in reason for reason in said)
    millimetres = pd.DataFrame(wanted, columns=["x_mm", "y_mm", "z_mm"])
    said = compensate_black_box(black_box(), as_path(millimetres, "path", sk120())).reasons
    assert all(said != "")


def test_another_arms_path_is_an_error():
    model, identified = physical()
    seven = pd.DataFrame(np.zeros((2, 7)), columns=[f"q{j}_rad" for j in range(1, 8)])
    with pytest.raises(InputError, match="6 motors"):
        as_path(seven, "path", model.arm)
    with pytest.raises(InputError, match="6-axis 20 kg"):
        compensate_physical(
            model, replace(identified, arm="other"), as_path(table_of(physical_path()[0]), "p", model.arm)
        )


def test_columns_without_units_are_an_error():
    with pytest.raises(InputError, match="unit"):
        as_path(pd.DataFrame(np.zeros((2, 3)), columns=["x", "y", "z"]), "path", sk120())


def test_a_full_pose_without_orientation_is_an_error():
    with pytest.raises(InputError, match="orientation"):
        compensate_black_box(black_box(), as_path(table_of(wanted_points(3)), "p", sk120()), Options(pose=True))
