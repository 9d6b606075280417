"""What the page of a diagnosis says with care: above what is to be done, and beside the errors that it promises."""

from dataclasses import replace

from armscope.report.pages.diagnosis import write_report
from tests.report import verdicts


def test_a_value_larger_than_arms_show_is_asked_about_before_anything_is_to_be_done(tmp_path):
    asked = verdicts.Notice("implausible", "Larger than arms show: a of link geometry at link 3 by +24 mm.")
    case = verdicts.case(effects=(verdicts.compliance(),), notices=(asked,))
    text = write_report(case.verdict, tmp_path).read_text()
    assert 0 < text.index("Larger than arms show") < text.index("What to do")


def test_a_row_that_makes_the_error_of_all_rows_is_told_beside_it(tmp_path):
    held_out = replace(verdicts.HeldOut(1.3, 0.1, folds=5), after_all_rows=7.4)
    shots = verdicts.SuspectRow("12", "a", 0.9, 0.1), verdicts.SuspectRow("54", "a", 130.0, 1e-9)
    case = verdicts.case(effects=(verdicts.compliance(),), held_out=held_out, suspects=shots)
    text = write_report(case.verdict, tmp_path).read_text().replace("\u00a0", " ")
    said = (
        "With the suspected bad shots it is 7.4 mm: the row with id 54 of run a lies 130 mm from where the model puts"
    )
    assert said in text
