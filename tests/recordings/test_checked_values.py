"""Numbers that can't be what a mapping says are refused by file, row and column; points of several reflectors too."""

from collections import Counter

import numpy as np
import pytest

from armscope.core.inputs import InputError
from armscope.recordings.importing.checked_values import whole
from armscope.recordings.importing.formats import TextFormat
from armscope.recordings.importing.mapping import Run
from armscope.recordings.importing.pieces import BesideFiles, Piece
from armscope.recordings.importing.rawfiles import read_pieces

from .raw import SIMPLE, convert


def test_a_point_is_there_as_a_whole_or_not_at_all(tmp_path):
    file = tmp_path / "raw.csv"
    file.write_text("n,x,y,z\n1,1,2,3\n2,,,\n3,4,,6\n")
    (rows,) = read_pieces(file, TextFormat(), Counter())
    piece = Piece(rows, BesideFiles(TextFormat(), Run(run="", file=""), {}, Counter()))
    with pytest.raises(InputError, match=r"line 4, column y: found nothing; a point is there as a whole"):
        whole(piece, ("x", "y", "z"), "a point")
    file.write_text("n,x,y,z\n1,1,2,3\n2,,,\n")
    (rows,) = read_pieces(file, TextFormat(), Counter())
    piece = Piece(rows, BesideFiles(TextFormat(), Run(run="", file=""), {}, Counter()))
    np.testing.assert_array_equal(whole(piece, ("x", "y", "z"), "a point"), [[1, 2, 3], [np.nan] * 3])


REFLECTORS = {"targets": {"a": ["x", "y", "z"], "b": ["u", "v", "w"]}, "unit": "mm"}


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("0,0,1,2,3,4,,6", r"line 2, column v: found nothing.*a point is there as a whole or not at all"),
        ("0,0,,,,,,", r"line 2, .*a row shows at least one reflector.*drop_missing: \[x\]"),
        ("0,0,1,2,3,4,5e9,6", r"line 2, column v.*a measured point lies within"),
    ],
)
def test_a_reflector_that_can_not_be_read_is_named(rows, message, tmp_path):
    mapping = {"columns": {"angles": SIMPLE["columns"]["angles"], "reflectors": REFLECTORS}}
    with pytest.raises(InputError, match=f"(?s){message}"):
        convert(tmp_path, f"j1,j2,x,y,z,u,v,w\n{rows}\n", mapping)


@pytest.mark.parametrize(
    ("groups", "message"),
    [
        ({"position": SIMPLE["columns"]["position"]}, "one of the three"),
        ({"target": {"constant": "c"}}, "`reflectors` name their targets"),
        ({"orientation": {"quaternion": [1, 2, 3, 4], "order": "wxyz"}}, "have no `orientation`"),
        ({"reflectors": {"targets": {"a": ["x", "y", "z"]}, "unit": "mm"}}, "at least 2"),
        ({"reflectors": {"targets": {"a": ["x", "y", "z"], "b": ["x", "y", "z"]}, "unit": "mm"}}, "in two places"),
    ],
)
def test_reflectors_stand_by_themselves(groups, message, tmp_path):
    columns = {"angles": SIMPLE["columns"]["angles"], "reflectors": REFLECTORS} | groups
    with pytest.raises(InputError, match=message):
        convert(tmp_path, "j1,j2,x,y,z,u,v,w\n0,0,1,2,3,4,5,6\n", {"columns": columns})
