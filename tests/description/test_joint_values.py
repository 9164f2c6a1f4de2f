import math

import pytest

from daidalos.description import urdf
from daidalos.description.joint import Mimic
from daidalos.description.joint_values import JointValues

TEXT = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="turn" type="continuous"><parent link="a"/><child link="b"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><limit lower="0.2" upper="0.6" effort="1"
velocity="1"/></joint>
<joint name="echo" type="revolute"><parent link="c"/><child link="d"/><limit lower="-1" upper="1" effort="1"
velocity="1"/><mimic joint="slide" multiplier="2" offset="0.1"/></joint>
<joint name="stiff" type="fixed"><parent link="d"/><child link="e"/></joint></robot>"""


def test_joints_begin_at_zero_or_in_the_middle_of_their_reach():
    values = JointValues(urdf.parse(TEXT))
    assert values.names == ("turn", "slide", "echo")
    assert [(r.name, r.lower, r.upper, r.zero) for r in values.ranges] == [
        ("turn", -math.pi, math.pi, 0.0),
        ("slide", 0.2, 0.6, 0.4),
    ]
    assert values.all_positions() == [0.0, 0.4, 2 * 0.4 + 0.1]


def test_mimics_follow():
    values = JointValues(urdf.parse(TEXT))
    values.take(["slide", "unknown"], [0.5, 9.0])
    assert values.position("echo") == 1.1


def test_speeds_and_efforts_of_who_follows_come_from_the_leader():
    values = JointValues(urdf.parse(TEXT))
    values.take(["slide"], velocities=[0.5], efforts=[3.0])
    assert values.all_velocities() == [0.0, 0.5, 1.0]
    assert values.all_efforts() == [0.0, 3.0, 3.0]


def test_soft_limits_bound_where_they_are_given():
    def reach(safety, **settings):
        text = TEXT.replace('<limit lower="0.2"', f'<safety_controller k_velocity="1"{safety}/><limit lower="0.2"')
        (slide,) = [each for each in JointValues(urdf.parse(text), **settings).ranges if each.name == "slide"]
        return slide.lower, slide.upper

    given = ' soft_lower_limit="0.3" soft_upper_limit="0.5"'
    assert reach(given) == (0.3, 0.5)
    assert reach(given, soft=False) == (0.2, 0.6)
    assert reach("") == (0.2, 0.6)


def test_mimics_may_be_let_alone_and_others_may_follow():
    values = JointValues(urdf.parse(TEXT), {"slide": 0.3}, mimics=False, dependents={"turn": Mimic("slide", 3.0, 0.0)})
    values.take(["echo"], [0.7])
    assert values.all_positions() == [3 * 0.3, 0.3, 0.7]


def test_those_who_follow_each_other_are_refused():
    circle = {"turn": Mimic("slide", 1, 0), "slide": Mimic("turn", 1, 0)}
    with pytest.raises(ValueError, match="infinite recursive mimic chain: slide, turn"):
        JointValues(urdf.parse(TEXT), mimics=False, dependents=circle)
    with pytest.raises(ValueError, match="infinite recursive mimic chain"):
        JointValues(urdf.parse(f"<urdf>{TEXT.partition('?>')[2] or TEXT}</urdf>"), mimics=False, dependents=circle)
