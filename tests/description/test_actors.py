import math

import pytest

from daidalos.description import sdf
from daidalos.description.actors import actor_pose
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import Mesh

WALK = (
    "<trajectory id='0' type='walk'><waypoint><time>1</time><pose>0 0 0 0 0 0</pose></waypoint>"
    "<waypoint><time>3</time><pose>4 0 0 0 0 3</pose></waypoint></trajectory>"
    "<trajectory id='1' type='walk'><waypoint><time>1</time><pose>4 2 0 0 0 -3</pose></waypoint></trajectory>"
)


def actor(script, extra=""):
    text = f"<actor name='a'><pose>9 9 9 0 0 0</pose>{extra}<script>{script}</script></actor>"
    (read,) = sdf.parse(f"<sdf version='1.9'><world name='w'>{text}</world></sdf>", "w.sdf").actors
    return read


def test_it_goes_from_waypoint_to_waypoint():
    walker = actor(f"<loop>0</loop>{WALK}")
    assert actor_pose(walker, 0.0).position == (0, 0, 0)
    assert actor_pose(walker, 2.0).position == pytest.approx((2, 0, 0))
    assert actor_pose(walker, 2.0).yaw == pytest.approx(1.5)
    assert actor_pose(walker, 3.5).position == pytest.approx((4, 1, 0))
    # From 3 to -3 radians the short way is over pi.
    assert abs(actor_pose(walker, 3.5).yaw) == pytest.approx(math.pi)
    assert actor_pose(walker, 99.0).position == (4, 2, 0)


def test_it_loops_waits_and_stands():
    assert actor_pose(actor(f"<loop>1</loop>{WALK}"), 4.0 + 2.0).position == pytest.approx((2, 0, 0))
    late = actor(f"<delay_start>10</delay_start>{WALK}")
    assert actor_pose(late, 5.0).position == (0, 0, 0)
    assert actor_pose(late, 12.0).position == pytest.approx((2, 0, 0))
    assert actor_pose(actor(f"<auto_start>0</auto_start>{WALK}"), 2.0).position == (0, 0, 0)
    assert actor_pose(actor(""), 2.0).position == (9, 9, 9)


def test_its_skin_and_links_are_read():
    skin = "<skin><filename>walk.dae</filename><scale>2</scale></skin>"
    walker = actor(WALK, f"{skin}<link name='body'><pose>0 0 1 0 0 0</pose></link>")
    assert walker.skin == "walk.dae"
    assert list(walker.model.links) == ["skin", "body"]
    assert walker.model.links["skin"].visuals[0].geometry == Mesh("walk.dae", None, (2, 2, 2))
    assert walker.model.scripted


def test_mistakes():
    with pytest.raises(DescriptionError, match=r"w.sdf:1: <waypoint>: <time> is missing"):
        actor("<trajectory id='0' type='w'><waypoint><pose>0 0 0 0 0 0</pose></waypoint></trajectory>")
