from daidalos.description import sdf, urdf
from daidalos.description.report import report, report_world, tree_text
from daidalos.description.tree import link_tree
from description.robots import ARM


def model(body):
    return sdf.parse_model(f"<sdf version='1.11'><model name='m'>{body}</model></sdf>", "m.sdf")


def joint(name, parent, child):
    return f"<joint name='{name}' type='revolute'><parent>{parent}</parent><child>{child}</child></joint>"


def test_a_robot_is_one_tree():
    tree = link_tree(urdf.parse(ARM))
    assert tree.roots == ("base",)
    assert [below.child for below in tree.children["fore"]] == ["finger", "thumb"]
    assert tree.closing == ()


def test_a_model_may_be_several_trees_and_hang_on_the_world():
    made = model("<link name='a'/><link name='b'/><link name='c'/>" + joint("j", "world", "b"))
    assert link_tree(made).roots == ("world", "a", "c")
    assert tree_text(made).splitlines() == [
        "model name is: m",
        "---------- Successfully Parsed XML ---------------",
        "root Link: world has 1 child(ren)",
        "    child(1):  b",
        "root Link: a has 0 child(ren)",
        "root Link: c has 0 child(ren)",
    ]


def test_loops_are_cut():
    links = "".join(f"<link name='{name}'/>" for name in "abcd")
    four_bars = model(links + joint("1", "a", "b") + joint("2", "b", "c") + joint("3", "a", "d") + joint("4", "d", "c"))
    tree = link_tree(four_bars)
    assert tree.roots == ("a",)
    assert [closing.name for closing in tree.closing] == ["4"]
    ring = model(links + joint("1", "a", "b") + joint("2", "b", "c") + joint("3", "c", "a"))
    tree = link_tree(ring)
    assert tree.roots == ("d", "a")
    assert [closing.name for closing in tree.closing] == ["3"]


def test_what_there_is_to_say_about_a_world():
    world = sdf.parse(
        """<sdf version="1.11"><world name="w"><physics><max_step_size>0.002</max_step_size></physics>
        <gravity>0 0 -1.6</gravity><light name="sun" type="directional"/><plugin name="p" filename="libp.so"/>
        <model name="floor"><static>true</static><link name="l"/></model>
        <model name="m"><pose>1 2 3 0 0 0</pose><link name="l"><inertial><mass>4</mass></inertial></link></model>
        </world></sdf>"""
    )
    known = report_world(world)
    assert (known.name, known.step, known.gravity) == ("w", 0.002, (0, 0, -1.6))
    assert (known.lights, known.actors, known.plugins) == (("sun",), (), ("libp.so",))
    assert [(placed.model.name, placed.static) for placed in known.models] == [("floor", True), ("m", False)]
    assert known.models[1].pose.position == (1, 2, 3)
    assert known.models[1].model.mass == 4


def test_a_joint_without_limits_has_none_in_words():
    made = model("<link name='a'/><link name='b'/>" + joint("j", "a", "b"))
    assert [found.limits for found in report(made).joints] == [""]
