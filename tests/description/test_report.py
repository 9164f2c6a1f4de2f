from daidalos.description import urdf
from daidalos.description.report import report, tree_text
from description.robots import ARM


def test_the_tree_as_check_urdf_prints_it():
    assert tree_text(urdf.parse(ARM)).splitlines() == [
        "robot name is: arm",
        "---------- Successfully Parsed XML ---------------",
        "root Link: base has 1 child(ren)",
        "    child(1):  upper",
        "        child(1):  fore",
        "            child(1):  finger",
        "            child(2):  thumb",
    ]


def test_everything_worth_knowing():
    known = report(urdf.parse(ARM))
    assert known.mass == 2
    assert [link.mass for link in known.links] == [2, None, None, None, None]
    assert known.links[0].implausibilities == ("2 kg in a box of 1, 2, 3 m is 0.333 kg/m^3",)
    assert known.links[1].implausibilities == ()
    limits = {joint.name: joint.limits for joint in known.joints}
    assert limits == {
        "shoulder": "-1 .. 2 rad, 3 rad/s, 10 N m",
        "elbow": "",
        "grip": "0 .. 0.1 m, 1 m/s, 1 N",
        "grip_mirror": "0 .. 0.1 m, 1 m/s, 1 N, = 2 * grip + 0.01",
    }
