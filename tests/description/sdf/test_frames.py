import math

import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import sdf
from daidalos.description.errors import DescriptionError
from daidalos.description.markup import parse_markup
from daidalos.description.sdf.frames import read_pose


def model(body, version="1.11"):
    return sdf.parse_model(f"<sdf version='{version}'><model name='m'>{body}</model></sdf>", "m.sdf")


def test_ways_to_write_a_pose():
    def pose(text):
        return read_pose(parse_markup(f"<a>{text}</a>")).pose

    quarter = Pose.from_xyz_rpy((1, 2, 3), (0, 0, math.pi / 2))
    for text in (
        "<pose>1 2 3 0 0 1.5707963267948966</pose>",
        "<pose degrees='true'>1 2 3 0 0 90</pose>",
        "<pose rotation_format='quat_xyzw'>1 2 3 0 0 2 2</pose>",
        "<pose>1 2 3\n 0 0 1.5707963267948966</pose>",
    ):
        assert pose(text).orientation == pytest.approx(quarter.orientation)
        assert pose(text).position == (1, 2, 3)
    assert pose("") == pose("<pose/>") == Pose()


def test_relative_to_links_frames_and_joints():
    made = model(
        """<link name="a"><pose>1 0 0 0 0 1.5707963267948966</pose></link>
        <frame name="f" attached_to="a"><pose>1 0 0 0 0 0</pose></frame>
        <frame name="g"><pose relative_to="f">0 0 1 0 0 0</pose></frame>
        <link name="b"><pose relative_to="g">0 1 0 0 0 0</pose>
          <collision name="c"><pose relative_to="a">0 0 7 0 0 0</pose>
            <geometry><empty/></geometry></collision>
        </link>
        <joint name="j" type="fixed"><pose>1 0 0 0 0 0</pose><parent>f</parent><child>b</child></joint>
        <link name="d"><pose relative_to="j">0 0 0 0 0 0</pose></link>"""
    )
    assert made.frames["f"].position == pytest.approx((1, 1, 0))
    assert made.frames["g"].position == pytest.approx((1, 1, 1))
    assert made.links["b"].pose.position == pytest.approx((0, 1, 1))
    assert made.links["d"].pose.position == pytest.approx((0, 2, 1))
    # In b's frame, a's origin is one to the left behind and below.
    assert made.links["b"].collisions[0].pose.position == pytest.approx((-1, -1, 6))
    joint = made.joints["j"]
    assert joint.parent == "a"
    assert joint.anchor.position == pytest.approx((1, 0, 0))
    assert joint.origin.position == pytest.approx((2, 1, 1))


def test_a_joint_may_name_models_for_their_canonical_links():
    made = model(
        """<model name="arm"><pose>1 0 0 0 0 0</pose><link name="l"/></model>
        <link name="a"/><link name="b"/><link name="c"/>
        <joint name="j" type="fixed"><parent>arm</parent><child>b</child></joint>
        <joint name="k" type="fixed"><parent>__model__</parent><child>c</child></joint>"""
    )
    assert (made.joints["j"].parent, made.joints["j"].origin.position) == ("arm::l", (-1, 0, 0))
    assert (made.joints["k"].parent, made.joints["k"].child) == ("a", "c")


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("<link name='a'><pose relative_to='b'/></link>", "there is no frame 'b'; known are a"),
        (
            "<link name='a'><pose relative_to='f'/></link><frame name='f' attached_to='a'/>",
            "circle: a -> f -> a",
        ),
        ("<link name='a'/><frame name='a'/>", "the name 'a' is used before"),
        ("<frame name='f' attached_to='g'/><frame name='g' attached_to='f'/>", "in a circle"),
    ],
)
def test_mistakes(body, words):
    with pytest.raises(DescriptionError, match=words):
        model(body)


@pytest.mark.parametrize("tag", ["visual", "collision", "sensor", "light"])
def test_what_is_on_a_link_stays_there_when_its_frame_is_not_known(tag):
    box = "<geometry><box><size>1 1 1</size></box></geometry>" if tag in ("visual", "collision") else ""
    made = model(
        f"<link name='l'><{tag} name='c' type='point'><pose relative_to='m'>1 2 3 0 0 0</pose>{box}</{tag}></link>"
    )
    (part,) = getattr(made.links["l"], f"{tag}s")
    assert part.pose.position == (1, 2, 3)
    (warning,) = made.warnings
    assert "there is no frame 'm'; its pose is taken relative to the link" in warning


@pytest.mark.parametrize(
    ("version", "axis", "expected"),
    [
        ("1.4", "<xyz>1 0 0</xyz>", (0, -1, 0)),
        ("1.5", "<xyz>1 0 0</xyz>", (1, 0, 0)),
        ("1.6", "<xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame>", (0, -1, 0)),
        ("1.9", "<xyz expressed_in='__model__'>1 0 0</xyz>", (0, -1, 0)),
        ("1.9", "<xyz expressed_in='p'>0 0 2</xyz>", (0, 0, 1)),
    ],
)
def test_axes_in_each_versions_frame(version, axis, expected):
    made = model(
        f"""<link name="p"/><link name="c"><pose>0 0 0 0 0 1.5707963267948966</pose></link>
        <joint name="j" type="revolute"><parent>p</parent><child>c</child><axis>{axis}</axis></joint>""",
        version,
    )
    assert made.joints["j"].axis.xyz == pytest.approx(expected)


NESTED = """<model name="arm"><pose>1 0 0 0 0 0</pose><link name="k"/><link name="l"><pose>0 2 0 0 0 0</pose></link>
  <frame name="tip" attached_to="l"><pose>0 0 3 0 0 0</pose></frame><frame name="foot"/></model>"""


@pytest.mark.parametrize(("end", "link"), [("arm::tip", "arm::l"), ("arm::foot", "arm::k"), ("g", "arm::l")])
def test_a_joint_may_name_frames_of_nested_models(end, link):
    made = model(
        f"""{NESTED}<link name="b"/><frame name="g" attached_to="arm::tip"/>
        <joint name="j" type="fixed"><parent>b</parent><child>{end}</child></joint>"""
    )
    assert made.joints["j"].child == link
    place = made.links[link].pose @ made.joints["j"].anchor
    assert place.position == pytest.approx(made.frames[end].position)


def test_frames_of_a_merged_model_are_those_of_the_model_around_it(tmp_path):
    (tmp_path / "arm.sdf").write_text(f"<sdf version='1.11'>{NESTED}</sdf>")
    text = """<sdf version='1.11'><model name='m'><include merge='true'><uri>arm.sdf</uri></include><link name='b'/>
        <joint name='j' type='fixed'><parent>b</parent><child>{}</child></joint></model></sdf>"""
    made = sdf.parse_model(text.format("tip"), str(tmp_path / "m.sdf"))
    assert made.joints["j"].child == "l"
    place = made.links["l"].pose @ made.joints["j"].anchor
    assert place.position == pytest.approx((1, 2, 3))
    with pytest.raises(DescriptionError, match="no link 'arm::l'"):
        sdf.parse_model(text.format("arm::l"), str(tmp_path / "m.sdf"))


@pytest.mark.parametrize(
    ("end", "link"), [("arm", "arm::k"), ("arm::tip", "arm::l"), ("g", "arm::l"), ("arm::l", "arm::l")]
)
def test_joints_of_a_world_may_name_models_and_frames(end, link):
    made = sdf.parse(
        f"""<sdf version="1.11"><world name="w">{NESTED}<frame name="g" attached_to="arm::tip"/>
        <joint name="j" type="fixed"><parent>world</parent><child>{end}</child></joint></world></sdf>"""
    )
    joint = made.joints["j"]
    assert joint.child == link
    place = made.models[0].pose @ made.models[0].links[link.removeprefix("arm::")].pose @ joint.anchor
    assert place.position == pytest.approx(made.frames[end].position)
    assert joint.origin.position == pytest.approx(made.frames[end].position)


def test_a_world_has_no_frame_that_is_attached_to_itself():
    with pytest.raises(DescriptionError, match=r"circle|itself"):
        sdf.parse(
            """<sdf version="1.11"><world name="w"><frame name="g" attached_to="h"/><frame name="h" attached_to="g"/>
            <joint name="j" type="fixed"><parent>world</parent><child>g</child></joint></world></sdf>"""
        )
