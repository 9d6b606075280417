"""A table that nobody can diagnose is refused with its reason."""

import pytest

from armscope.check.preconditions import check_table
from armscope.core.inputs import InputError
from tests.diagnosis.planted import planted


def test_a_table_without_rows_is_one_clear_error() -> None:
    arm, table = planted("six-axis", {}, 10, 0.02, seed=1)
    with pytest.raises(InputError, match=r"0 rows.*four poses"):
        check_table(arm, table.rows(slice(0)))
