"""Which links and joints are asked whether they follow a joint before them."""

from armscope.physics.unexplained_turn import UNEXPLAINED_TURN, bowing_links, led_joints


def test_only_joints_before_it_lead_a_link() -> None:
    found = [(placed.location, placed.driver) for placed in bowing_links([1, 2, 3], 4)]
    assert found == [
        ("link 2", "turn of joint 1"),
        ("link 3", "turn of joint 1"),
        ("link 3", "turn of joint 2"),
    ]


def test_a_joint_that_stood_still_leads_none_and_all_pay_for_each_other() -> None:
    found = led_joints([1, 3, 4])
    assert [(placed.location, placed.driver) for placed in found] == [
        ("joint 3", "turn of joint 1"),
        ("joint 4", "turn of joint 1"),
        ("joint 4", "turn of joint 3"),
    ]
    assert {placed.multiplicity for placed in found} == {30}
    assert all(placed.effect is UNEXPLAINED_TURN and placed.nameless for placed in found)


def test_it_has_words_of_its_own() -> None:
    assert "dial gauge" in UNEXPLAINED_TURN.confirm
    assert "armscope compensate" in str(UNEXPLAINED_TURN.cure)
