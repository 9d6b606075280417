"""A sweep's table: read whole, or refused with row and column."""

from pathlib import Path

import pytest

from armscope.core.inputs import InputError
from armscope.core.variants import read_variants

DEFAULT = Path(__file__).parents[2] / "config" / "sweeps" / "default.csv"
HEADER = "id,sweep,family,order,space,particles,iterations,update,neighbourhood,seeds\n"
GOOD = "a1,particles,fourier,2,angular,10,200,constriction,gbest,20\n"


def test_the_default_table_varies_what_its_sweeps_say():
    by_sweep = {}
    for variant in read_variants(DEFAULT):
        by_sweep.setdefault(variant.sweep, []).append(variant.varied)
    assert by_sweep["particles"] == [10, 20, 50, 100, 200]
    assert by_sweep["update"] == ["constriction", "inertia", "original"]
    assert by_sweep["degree (angular)"] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize(
    ("text", "place", "found"),
    [
        (HEADER + GOOD.replace(",10,", ",one,"), "line 2, column particles", "one"),
        (HEADER + GOOD.replace(",200,", ",0,"), "line 2, column iterations", "0"),
        (HEADER + GOOD.replace("constriction", "original2"), "line 2, column update", "original2"),
        (HEADER + GOOD + GOOD, "line 3, column id", "a1"),
        (HEADER.replace("particles", "partikles") + GOOD, "line 1", "partikles"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(tmp_path, text, place, found):
    path = tmp_path / "sweep.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_variants(path)
    assert caught.value.place == place
    assert caught.value.found == found
