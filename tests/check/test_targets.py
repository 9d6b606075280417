"""A table whose every row has a target of its own is told as that, by whatever looks at it."""

from dataclasses import replace

import numpy as np
import pytest

from armscope.check.preconditions import refuse_unusable
from armscope.check.report import check
from armscope.compensation.fitting import fit_error_model
from armscope.core.inputs import InputError
from armscope.errormodels.features import FDP_CI

TOLD = "column target: 80 different names in 80 rows"


@pytest.fixture
def numbered(sound):
    return replace(sound, target=np.arange(80).astype(str))


def test_check_tells_that_targets_number_the_rows(numbered, arm):
    for report in (check(numbered), check(numbered, arm)):
        assert [each.text() for each in report.suspicions if TOLD in each.text()]
        assert report.has_problems
        assert "too few rows" not in report.text()
        assert "is it the point's number?" in report.text()


def test_a_diagnosis_and_an_error_model_refuse_them(numbered, arm):
    with pytest.raises(InputError, match=TOLD):
        refuse_unusable(arm, numbered)
    with pytest.raises(InputError, match=r"found '80 different names in 80 rows'.*is it the point's number\?"):
        fit_error_model(arm, numbered, FDP_CI)
