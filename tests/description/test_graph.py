import re

from daidalos.description import sdf, urdf
from daidalos.description.graph import to_dot, to_svg
from daidalos.description.markup import parse_markup
from description.robots import ARM
from simulation.models import turtlebot


def boxes(svg):
    pattern = r'<rect x="([-\d.]+)" y="([-\d.]+)" width="([\d.]+)" height="([\d.]+)"'
    return [tuple(float(number) for number in found) for found in re.findall(pattern, svg)]


def test_the_drawing_is_xml_with_every_name():
    svg = to_svg(urdf.parse(ARM.replace('name="thumb"', 'name="a &lt; b"').replace('link="thumb"', 'link="a &lt; b"')))
    texts = [element.text for element in parse_markup(svg).walk() if element.tag == "text"]
    assert {"base", "upper", "fore", "finger", "a < b", "shoulder", "grip_mirror", "continuous"} <= set(texts)


def test_boxes_do_not_overlap_and_stay_inside():
    for robot in (urdf.parse(ARM), turtlebot()):
        svg = to_svg(robot)
        width, height = (float(size) for size in re.search(r'viewBox="0 0 (\d+) (\d+)"', svg).groups())
        found = boxes(svg)
        assert len(found) == len(robot.links)
        for i, (x, y, w, h) in enumerate(found):
            assert x >= 0
            assert y >= 0
            assert x + w <= width
            assert y + h <= height
            for other_x, other_y, other_w, _ in found[i + 1 :]:
                assert y != other_y or x + w < other_x or other_x + other_w < x


def test_a_deep_robot_is_no_problem():
    links = "".join(f"<link name='l{i}'/>" for i in range(1500))
    joints = "".join(
        f"<joint name='j{i}' type='fixed'><parent link='l{i}'/><child link='l{i + 1}'/></joint>" for i in range(1499)
    )
    assert len(boxes(to_svg(urdf.parse(f"<robot name='r'>{links}{joints}</robot>")))) == 1500


def test_graphviz():
    dot = to_dot(urdf.parse(ARM))
    assert '"base" -> "shoulder" [label="xyz: 0 0 1 \\nrpy: 0 0 1.5708"]' in dot
    assert '"shoulder" -> "upper"' in dot
    assert dot.startswith("digraph G {")


def test_labels_of_joints_to_the_same_link_do_not_hide_each_other():
    text = """<sdf version="1.9"><model name="m"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
    {}</model></sdf>""".format(
        "".join(
            f"<joint name='{p}{c}' type='ball'><parent>{p}</parent><child>{c}</child></joint>"
            for p, c in ("ab", "bc", "ad", "dc")
        )
    )
    svg = to_svg(sdf.parse_model(text))
    places = {name: (x, y) for x, y, name in re.findall(r'<text x="([-\d.]+)" y="([-\d.]+)"[^>]*>(\w\w)</text>', svg)}
    assert set(places) == {"ab", "bc", "ad", "dc"}
    assert len(set(places.values())) == 4
    assert svg.index("<path d=", svg.index("</defs>")) < svg.rindex("<path d=") < svg.index(">ab</text>")
