"""A variant of a sweep: what its swarms leave, beside least squares on the same rows."""

import numpy as np

from armscope.core.variants import Variant
from armscope.paper.sweep import run_variant


def test_the_excess_is_of_the_number_beside_it(study):
    variant = Variant(
        id="few", sweep="iterations", family="polynomial", order=1, space="cartesian", particles=10, iterations=2,
        update="constriction", neighbourhood="gbest", seeds=2,
    )  # fmt: skip
    table = run_variant(study.measurements, variant, 3, "standardised", "per axis", "numpy")
    told = table["least_squares_mm"] * (1 + table["excess_percent"] / 100)
    np.testing.assert_allclose(told, table["rms_mm"])
    fitted = table[table["trajectory"] == "identification"]
    assert (fitted["excess_percent"] > 0).all()
