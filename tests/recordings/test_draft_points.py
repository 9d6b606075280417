"""Which columns of a foreign table are points: the measured one, or those of several reflectors."""

import pytest

from armscope.recordings.importing.draft_columns import points_of
from armscope.recordings.importing.first_table import first_table


@pytest.mark.parametrize(
    ("header", "found"),
    [
        ("q1,q2,x,y,z", [[2, 3, 4]]),
        ("q1,q2,x1,y1,z1,x2,y2,z2", [[2, 3, 4], [5, 6, 7]]),
        ("q1,q2,smr2_x,smr2_y,smr2_z,smr1_x,smr1_y,smr1_z", [[5, 6, 7], [2, 3, 4]]),
        ("q1,q2,x_cmd,y_cmd,z_cmd,x_meas,y_meas,z_meas", [[5, 6, 7]]),  # commanded and measured: one point
        ("q1,q2,x1,y1,z1,x3,y3,z3", [[2, 3, 4]]),  # no second one: something else may be meant
        ("q1,q2,x1,y1,z1,x2,y2,w2", [[2, 3, 4]]),
        ("q1,q2,PosX,PosY,PosZ", [[2, 3, 4]]),
        ("q1,q2,posx,posy,posz", [[2, 3, 4]]),
        ("q1,q2,TrackerX,TrackerY,TrackerZ", [[2, 3, 4]]),
        ("q1,q2,测量X,测量Y,测量Z", [[2, 3, 4]]),
        ("q1,q2,a,b,c", []),
    ],
)
def test_points_are_found_by_likeness_of_names(header, found, tmp_path):
    file = tmp_path / "foreign.csv"
    rows = "\n".join(",".join(str(0.1 * n + k) for k in range(header.count(",") + 1)) for n in range(5))
    file.write_text(f"{header}\n{rows}\n")
    assert points_of(first_table(file), taken=[0, 1]) == found
