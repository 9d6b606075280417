"""Which columns of a foreign table are motor angles: the longest numbered row of a known word, or named joints."""

import numpy as np
import pytest

from armscope.recordings.importing.draft_columns import largest_of, motor_columns, words_of
from armscope.recordings.importing.first_table import first_table


@pytest.mark.parametrize(
    ("header", "found"),
    [
        ("J1,J2,J3,x,y,z", [0, 1, 2]),
        ("x,y,z,Eje 1 (deg),Eje 2 (deg)", [3, 4]),
        ("关节1,关节2,关节3,x,y,z", [0, 1, 2]),
        ("q1,q2,q3,q4,j1,j2,j3,j4,j5,j6", [4, 5, 6, 7, 8, 9]),
        ("q1_act,q2_act,q1_cmd,q2_cmd,x,y,z", [2, 3]),
        ("current1,current2,x,y,z", []),
        ("S,L,U,R,B,T,x,y,z", [0, 1, 2, 3, 4, 5]),
        (
            "wrist_1_joint,shoulder_pan_joint,shoulder_lift_joint,elbow_joint,wrist_2_joint,wrist_3_joint",
            [1, 2, 3, 0, 4, 5],
        ),
    ],
)
def test_motors_are_found_by_likeness_of_names(header, found, tmp_path):
    rows = "\n".join(",".join(str(0.1 * n + k) for k in range(header.count(",") + 1)) for n in range(5))
    (tmp_path / "foreign.csv").write_text(f"{header}\n{rows}\n", encoding="utf-8")
    assert motor_columns(first_table(tmp_path / "foreign.csv")) == found


def test_words_and_sizes():
    assert words_of("Joint 3 [°]") == ["joint", "°"]
    assert largest_of(np.array([1.0, -3.0, np.nan])) == 3
    assert largest_of(np.array([np.nan])) == 0
