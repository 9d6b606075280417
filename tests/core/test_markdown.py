from armscope.core.markdown import table_lines


def test_a_table_has_a_rule_as_wide_as_its_head():
    lines = table_lines(["arm", ""], [("a", 1), ("b", 0.5)])
    assert lines == [
        "| arm | |",
        "|---|---|",
        "| a | 1 |",
        "| b | 0.5 |",
    ]
