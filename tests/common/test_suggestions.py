from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.suggestions import MIN_LIKENESS, _likeness, did_you_mean, hint_line, near, near_or_all

TOPICS = ["/chatter", "/lab/enable", "/lab/add_two_ints", "/scan"]


def test_a_slip_is_recognised():
    assert near("/chater", TOPICS) == ["/chatter"]
    assert near("/Chatter", TOPICS) == ["/chatter"]


def test_a_forgotten_namespace_is_recognised():
    assert near("/add_two_ints", TOPICS) == ["/lab/add_two_ints"]


def test_a_shared_beginning_makes_no_likeness():
    assert near("/lab/none", TOPICS) == []
    assert near("std_srvs/srv/Nope", ["std_srvs/srv/Empty", "std_srvs/srv/SetBool"]) == []


def test_the_nearest_comes_first_and_three_are_enough():
    names = ["speed", "speeds", "spread", "speedy", "spend"]
    assert near("speeed", names)[0] == "speed"
    assert len(near("speeed", names)) == 3


def test_texts():
    assert did_you_mean("/chater", TOPICS) == "\nDid you mean '/chatter'?"
    assert hint_line("/chater", TOPICS) == "Did you mean '/chatter'?\n"
    assert did_you_mean("/nothing", TOPICS) == hint_line("/nothing", TOPICS) == ""


def test_few_names_are_listed_and_many_are_counted():
    assert near_or_all("/chater", TOPICS, "topics") == "Did you mean '/chatter'?\n"
    assert near_or_all("/x", ["/b", "/a", "/x"], "topics") == "There are these topics: /a, /b\n"
    assert near_or_all("/x", [], "topics") == "There are no topics\n"
    many = [f"/number_{number}" for number in range(30)]
    assert near_or_all("/x", many, "topics") == "There is no '/x' among 30 topics\n"


@given(st.text("ab/:", max_size=8), st.lists(st.text("ab/:", max_size=8), max_size=4))
def test_the_quick_filter_drops_nothing_that_is_near(name, known):
    """The filter of upper bounds changes no answer."""
    likeness = {other: _likeness(name, other) for other in known if other != name}
    expected = sorted((o for o in likeness if likeness[o] >= MIN_LIKENESS), key=lambda o: (-likeness[o], o))
    assert near(name, known) == expected[:3]
