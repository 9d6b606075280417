import numpy as np

from armscope.errormodels.folds import FOLDS, compare_sizes, fold_numbers


def test_every_row_is_held_out_once_and_folds_are_even():
    folds = fold_numbers(23, np.random.default_rng(0))
    assert np.bincount(folds, minlength=FOLDS).tolist() == [5, 5, 5, 4, 4]


def test_the_smallest_within_one_standard_error_of_the_best_is_chosen():
    # mean squares 4, 1.02, 1 with a scatter of 0.1 between the folds: the last two can't be told apart
    scatter = np.array([-0.1, 0.1, -0.1, 0.1, 0.0])[:, None]
    table = compare_sizes("terms", [1, 2, 3], np.array([4.0, 1.0, 0.9]), np.array([4.0, 1.02, 1.0]) + scatter)
    assert table["chosen"].tolist() == [False, True, False]
    assert np.allclose(table["held_out_rms_mm"], np.sqrt([4.0, 1.02, 1.0]))
    # of a root: half the standard error of the square, over the root
    assert np.allclose(table["stderr_mm"], np.std(scatter, ddof=1) / np.sqrt(5) / (2 * table["held_out_rms_mm"]))


def test_without_scatter_the_best_itself_is_chosen():
    table = compare_sizes("regions", [1, 2], np.array([1.0, 0.5]), np.tile([1.0, 0.99], (FOLDS, 1)))
    assert table["chosen"].tolist() == [False, True]
