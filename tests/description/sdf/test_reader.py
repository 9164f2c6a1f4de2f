import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.pose3 import Pose
from daidalos.description import sdf
from daidalos.description.errors import DescriptionError
from daidalos.description.geometry import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Empty,
    Heightmap,
    Mesh,
    Plane,
    Polyline,
    Sphere,
)
from daidalos.description.joint import JointType
from daidalos.description.markup import parse_markup
from daidalos.description.sdf.context import BUILT_IN_MODELS
from description.robots import ARM, SHARE, problem_of
from properties import examples

WORLD = """<?xml version="1.0"?>
<sdf version="1.9">
  <world name="w">
    <gravity>0 0 -3.7</gravity>
    <magnetic_field>1e-5 0 2e-5</magnetic_field>
    <physics type="ode"><max_step_size>0.002</max_step_size><real_time_factor>2</real_time_factor></physics>
    <scene><ambient>0.1 0.2 0.3</ambient><shadows>0</shadows></scene>
    <wind><linear_velocity>1 2 3</linear_velocity></wind>
    <spherical_coordinates><latitude_deg>47</latitude_deg><longitude_deg>8</longitude_deg></spherical_coordinates>
    <atmosphere type="adiabatic"><pressure>90000</pressure></atmosphere>
    <include><uri>model://sun</uri></include>
    <include><uri>model://ground_plane</uri></include>
    <light name="lamp" type="spot">
      <pose>0 0 3 0 0 0</pose><diffuse>1 1 0 1</diffuse><attenuation><range>5</range></attenuation>
      <spot><inner_angle>0.2</inner_angle><outer_angle>0.5</outer_angle></spot>
    </light>
    <frame name="table"><pose>0 5 0 0 0 0</pose></frame>
    <model name="cart">
      <pose relative_to="table">1 0 0 0 0 0</pose>
      <link name="body">
        <inertial><mass>3</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz></inertia></inertial>
        <collision name="c">
          <geometry><box><size>1 2 3</size></box></geometry>
          <surface><friction><ode><mu>0.4</mu><mu2>0.3</mu2></ode></friction>
            <bounce><restitution_coefficient>0.5</restitution_coefficient></bounce>
            <contact><collide_bitmask>0x02</collide_bitmask></contact></surface>
          <laser_retro>7</laser_retro>
        </collision>
        <visual name="v"><geometry><sphere><radius>2</radius></sphere></geometry>
          <material><script><name>Gazebo/Red</name></script></material><transparency>0.5</transparency></visual>
        <sensor name="s" type="imu"><update_rate>100</update_rate><topic>imu</topic></sensor>
      </link>
      <link name="wheel"><pose>0 1 0 0 0 0</pose></link>
      <joint name="axle" type="revolute"><parent>body</parent><child>wheel</child>
        <axis><xyz>0 1 0</xyz><limit><lower>-1e16</lower><upper>1e16</upper><effort>-1</effort></limit>
          <dynamics><damping>0.1</damping><spring_stiffness>2</spring_stiffness></dynamics></axis></joint>
      <plugin name="p" filename="libp.so"/>
    </model>
    <plugin name="q" filename="libq.so"/>
  </world>
</sdf>
"""


def test_everything_in_a_world_is_read():
    world = sdf.parse(WORLD)
    assert world.name == "w"
    assert world.gravity == (0, 0, -3.7)
    assert world.magnetic_field == (1e-5, 0, 2e-5)
    assert world.physics.max_step_size == 0.002
    assert world.physics.real_time_factor == 2
    assert world.scene.ambient == (0.1, 0.2, 0.3, 1)
    assert not world.scene.shadows
    assert world.wind == (1, 2, 3)
    assert world.spherical_coordinates.latitude == 47
    assert world.atmosphere.pressure == 90000
    assert [light.name for light in world.lights] == ["sun", "lamp"]
    assert world.lights[1].spot_outer_angle == 0.5
    assert [plugin.name for plugin in world.plugins] == ["q"]
    ground, cart = world.models
    assert ground.static
    assert isinstance(ground.links["link"].collisions[0].geometry, Plane)
    assert cart.pose == Pose((1, 5, 0))
    body = cart.links["body"]
    assert body.inertial.inertia == (0.1, 0, 0, 0.2, 0, 0.25)
    surface = body.collisions[0].surface
    assert (surface.mu, surface.mu2, surface.restitution, surface.bitmask) == (0.4, 0.3, 0.5, 2)
    assert body.collisions[0].laser_retro == 7
    assert body.visuals[0].material.color[:3] == (0.9, 0.05, 0.05)
    assert body.visuals[0].transparency == 0.5
    assert (body.sensors[0].type, body.sensors[0].update_rate, body.sensors[0].topic) == ("imu", 100, "imu")
    assert cart.links["wheel"].inertial.mass == 1
    axle = cart.joints["axle"]
    assert axle.type is JointType.REVOLUTE
    assert (axle.axis.lower, axle.axis.upper, axle.axis.effort) == (-math.inf, math.inf, math.inf)
    assert (axle.axis.damping, axle.axis.spring_stiffness) == (0.1, 2)
    assert axle.origin == Pose((0, 1, 0))
    assert not world.warnings


@pytest.mark.parametrize(
    ("text", "shape"),
    [
        ("<box><size>1 2 3</size></box>", Box((1, 2, 3))),
        ("<sphere><radius>2</radius></sphere>", Sphere(2)),
        ("<cylinder><radius>2</radius><length>3</length></cylinder>", Cylinder(2, 3)),
        ("<capsule><radius>2</radius><length>3</length></capsule>", Capsule(2, 3)),
        ("<cone><radius>2</radius><length>3</length></cone>", Cone(2, 3)),
        ("<ellipsoid><radii>1 2 3</radii></ellipsoid>", Ellipsoid((1, 2, 3))),
        ("<plane><normal>0 3 0</normal><size>4 5</size></plane>", Plane((0, 1, 0), (4, 5))),
        (
            "<mesh><uri>model://x/a.dae</uri><scale>1 1 2</scale>"
            "<submesh><name>p</name><center>1</center></submesh></mesh>",
            Mesh("model://x/a.dae", None, (1, 1, 2), "p", True),
        ),
        (
            "<heightmap><uri>h.png</uri><size>9 9 2</size><pos>0 0 1</pos></heightmap>",
            Heightmap("h.png", None, (9, 9, 2), (0, 0, 1)),
        ),
        (
            "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>2</height></polyline>"
            "<polyline><point>0 0</point><point>.5 0</point><point>0 .5</point></polyline>",
            Polyline((((0, 0), (1, 0), (0, 1)), ((0, 0), (0.5, 0), (0, 0.5))), 2),
        ),
        ("<empty/>", Empty()),
        ("<blob/>", Empty()),
    ],
)
def test_shapes(text, shape):
    model = sdf.parse_model(
        "<sdf version='1.9'><model name='m'><link name='l'><collision name='c'>"
        f"<geometry>{text}</geometry></collision></link></model></sdf>"
    )
    assert model.links["l"].collisions[0].geometry == shape
    assert len(model.warnings) == (1 if "blob" in text else 0)


def test_inertia_can_be_computed_from_the_collisions():
    """SDF 1.11: a cube of 1 m and 500 kg/m^3 beside one of the default density, and a mass that wins."""
    box = (
        "<collision name='{}'><pose>{} 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry>{}</collision>"
    )
    shapes = box.format("a", 0, "<density>500</density>") + box.format("b", 3, "")
    text = (
        "<sdf version='1.11'><model name='m'><link name='l'><inertial auto='true'>{}</inertial>{}</link></model></sdf>"
    )
    inertial = sdf.parse_model(text.format("", shapes)).links["l"].inertial
    assert inertial.mass == pytest.approx(1500)
    assert inertial.pose.position == pytest.approx((2, 0, 0))
    assert inertial.inertia[0] == pytest.approx(1500 / 6)
    light = sdf.parse_model(text.format("<mass>3</mass>", shapes)).links["l"].inertial
    assert (light.mass, light.inertia[0]) == (pytest.approx(3), pytest.approx(0.5))
    with pytest.raises(DescriptionError, match="auto needs collisions"):
        sdf.parse_model(text.format("", ""))


def folder_of_models(tmp_path):
    arm = "<link name='base'/><link name='tip'><pose>0 0 1 0 0 0</pose></link>"
    joint = "<joint name='j' type='revolute'><parent>base</parent><child>tip</child></joint>"
    for name, body in {
        "arm": arm + joint + "<frame name='mount'><pose>0 0 0.5 0 0 0</pose></frame><plugin name='p' filename='x'/>",
        "robot": "<link name='chassis'/><include><uri>model://arm</uri><name>left</name>"
        "<pose>0 1 0 0 0 0</pose></include><joint name='weld' type='fixed'><parent>chassis</parent>"
        "<child>left::base</child></joint>",
    }.items():
        folder = tmp_path / name
        folder.mkdir()
        (folder / "model.config").write_text(
            "<model><sdf version='1.4'>old.sdf</sdf><sdf version='1.9'>new.sdf</sdf></model>"
        )
        (folder / "new.sdf").write_text(f"<sdf version='1.9'><model name='{name}'>{body}</model></sdf>")
    return tmp_path


def included(tmp_path, include, **options):
    text = f"<sdf version='1.9'><world name='w'>\n{include}</world></sdf>"
    return sdf.parse(text, str(tmp_path / "w.sdf"), model_path=[tmp_path], **options)


def test_nested_models_are_flattened(tmp_path):
    folder_of_models(tmp_path)
    world = included(tmp_path, "<include><uri>model://robot</uri><pose>5 0 0 0 0 0</pose></include>")
    (robot,) = world.models
    assert list(robot.links) == ["chassis", "left::base", "left::tip"]
    assert robot.links["left::tip"].pose == Pose((0, 1, 1))
    assert robot.joints["left::j"].parent == "left::base"
    assert robot.frames["left::mount"] == Pose((0, 1, 0.5))
    assert robot.plugins[0].scope == "left"
    assert world.frames["robot::left::tip"] == Pose((5, 1, 1))


@pytest.mark.parametrize(
    ("inside", "links", "parent", "words"),
    [
        ("", ["hook"], "world", "taken for the world"),
        ("<inertial><mass>1</mass></inertial>", ["world_link", "hook"], "world_link", "the link is called world_link"),
    ],
)
def test_a_link_called_world_is_the_world_unless_it_is_a_body(inside, links, parent, words):
    world = sdf.parse(
        f"<sdf version='1.6'><world name='w'><model name='m'><link name='world'>{inside}</link>"
        "<link name='hook'><pose>0 0 2 0 0 0</pose></link><joint name='j' type='fixed'><parent>world</parent>"
        "<child>hook</child></joint></model></world></sdf>"
    )
    (model,) = world.models
    assert list(model.links) == links
    assert model.joints["j"].parent == parent
    assert model.joints["j"].origin == Pose((0, 0, 2))
    assert words in world.warnings[0]


def test_merged_models_lose_their_name(tmp_path):
    folder_of_models(tmp_path)
    model = sdf.parse_model(
        "<sdf version='1.9'><model name='m'><include merge='true'><uri>model://arm</uri>"
        "<pose>1 0 0 0 0 0</pose></include><frame name='f' attached_to='tip'/></model></sdf>",
        model_path=[tmp_path],
    )
    assert list(model.links) == ["base", "tip"]
    assert model.frames["f"] == Pose((1, 0, 1))


def test_what_an_include_says_wins(tmp_path):
    folder_of_models(tmp_path)
    world = included(
        tmp_path,
        "<include><uri>model://arm</uri><name>a</name><static>1</static><placement_frame>tip</placement_frame>"
        "<pose>3 0 0 0 0 0</pose><plugin name='extra' filename='y'/></include><include><uri>model://arm</uri></include>"
        "<include><uri>model://arm</uri></include>",
    )
    first, second, third = world.models
    assert (first.name, first.static, first.pose) == ("a", True, Pose((3, 0, -1)))
    assert [plugin.name for plugin in first.plugins] == ["p", "extra"]
    assert (second.name, third.name) == ("arm", "arm_0")
    assert "the name 'arm' is taken, called arm_0" in world.warnings[0]


def test_a_urdf_can_be_included(tmp_path):
    (tmp_path / "arm.urdf").write_text(ARM)
    world = included(tmp_path, "<include><uri>arm.urdf</uri><pose>0 0 2 0 0 0</pose></include>")
    assert world.models[0].links["fore"].pose.position == pytest.approx((0, 1, 1))
    assert world.models[0].pose == Pose((0, 0, 2))


@pytest.mark.parametrize(
    ("include", "words"),
    [
        (
            "<include><uri>model://chair</uri></include>",
            r"w.sdf:2: <include>: model://chair not found; looked in",
        ),
        ("<include/>", "<uri> is missing"),
        ("<include><uri>https://fuel/x</uri></include>", "not among Gazebo Fuel's downloads"),
        ("<include><uri>gone.sdf</uri></include>", "gone.sdf not found; looked beside"),
        ("<include><uri>model://empty</uri></include>", "neither model.config nor model.sdf"),
        ("<include><uri>model://loop</uri></include>", "includes itself"),
    ],
)
def test_includes_that_fail(tmp_path, include, words):
    (tmp_path / "empty").mkdir()
    (tmp_path / "loop").mkdir()
    (tmp_path / "loop/model.sdf").write_text(
        "<sdf version='1.9'><model name='l'><include><uri>model://loop</uri></include></model></sdf>"
    )
    with pytest.raises(DescriptionError, match=words):
        included(tmp_path, include, strict=True)


def test_the_world_around_a_missing_model_loads(tmp_path):
    world = included(
        tmp_path,
        """
<include><uri>model://chair</uri><pose>1 0 0 0 0 0</pose></include>
<include><uri>https://fuel.gazebosim.org/1.0/owner/models/Tall Lamp/2</uri></include>
<model name="box"><pose relative_to="chair">0 2 0 0 0 0</pose><link name="body"/></model>
<joint name="glue" type="fixed"><parent>box</parent><child>Tall Lamp::foot</child></joint>
<joint name="hold" type="fixed"><parent>world</parent><child>box</child></joint>
<model name="chair_stand"><link name="leg"/>
  <include><uri>model://chair</uri><name>seat</name></include>
  <joint name="screw" type="fixed"><parent>leg</parent><child>seat::board</child></joint>
  <joint name="foot" type="fixed"><parent>world</parent><child>leg</child></joint>
</model>
<model name="robot"><link name="base"/>
  <include merge="true"><uri>model://chair</uri></include>
  <joint name="neck" type="fixed"><parent>base</parent><child>head</child></joint>
</model>""",
    )
    box, stand, robot = world.models
    assert box.pose.position == (1, 2, 0)
    assert list(world.joints) == ["hold"]
    assert list(stand.joints) == ["foot"]
    assert not robot.joints
    missing = [line.rpartition("/")[2] for line in world.warnings]
    assert "w.sdf:3: <include>: model://chair not found; looked in" in " ".join(missing + list(world.warnings))
    assert sum("; left out" in line for line in world.warnings) == 4
    assert sum("left out, as is one of" in line for line in world.warnings) == 3


def test_ground_and_sun_of_gazebo_fuel_are_our_own(tmp_path):
    address = "<include><uri>https://fuel.gazebosim.org/1.0/OpenRobotics/models/{}</uri></include>"
    world = included(tmp_path, address.format("Ground Plane") + address.format("Sun"))
    assert [model.name for model in world.models] == ["ground_plane"]
    assert [light.name for light in world.lights] == ["sun"]
    assert not world.warnings


def test_a_saved_world_stands_as_it_was_when_it_was_saved():
    world = sdf.parse(
        """<sdf version="1.7"><world name="w">
<light name="lamp" type="point"><pose>0 0 1 0 0 0</pose></light>
<state world_name="w"><sim_time>792 318000000</sim_time>
<model name="box"><pose>1 2 3 0 0 1.5</pose><link name="body"><pose>1 2 3.5 0 0 1.5</pose></link></model>
<model name="gone"><pose>9 9 9 0 0 0</pose></model><model name="cup"/>
<light name="lamp"><pose>0 0 5 0 0 0</pose></light></state>
<model name="box"><pose>7 0 0 0 0 0</pose><link name="body"><pose>0 0 0.5 0 0 0</pose></link></model>
<model name="cup"><pose relative_to="box">1 0 0 0 0 0</pose><link name="body"/></model>
</world></sdf>"""
    )
    box, cup = world.models
    assert box.pose == Pose.from_xyz_rpy((1, 2, 3), (0, 0, 1.5))
    assert box.links["body"].pose.position == (0, 0, 0.5)
    assert cup.pose.position == pytest.approx((1 + math.cos(1.5), 2 + math.sin(1.5), 3))
    assert world.lights[0].pose.position == (0, 0, 5)


def test_what_fell_out_of_the_world_is_left_out():
    world = sdf.parse(
        """<sdf version="1.6"><world name="w"><model name="near"><link name="l"/></model>
<model name="lost"><pose>1 2 -7.5e+08 0 0 0</pose><link name="l"/></model></world></sdf>""",
        "w.sdf",
    )
    assert [model.name for model in world.models] == ["near"]
    assert world.warnings == ("w.sdf:2: <model name=\"lost\">: 'lost' is 7.5e+08 m away, left out",)


LABEL = "<plugin filename='gz-sim-label-system' name='gz::sim::systems::Label'><label>{}</label></plugin>"


def test_labels_of_models_and_includes_are_those_of_their_visuals(tmp_path):
    visual = "<visual name='{}'><geometry><sphere><radius>1</radius></sphere></geometry>{}</visual>"
    links = f"<link name='l'>{visual.format('a', '')}{visual.format('b', LABEL.format(3))}</link>"
    (tmp_path / "ball").mkdir()
    (tmp_path / "ball/model.sdf").write_text(f"<sdf version='1.9'><model name='ball'>{links}</model></sdf>")
    inner = "<include><uri>model://ball</uri></include>"
    world = included(
        tmp_path,
        f"<model name='one'>{links}{inner}{LABEL.format(1)}</model>"
        f"<include><uri>model://ball</uri>{LABEL.format(2)}</include>{inner.replace('</uri>', '</uri><name>c</name>')}",
    )
    labels = [[v.label for link in model.links.values() for v in link.visuals] for model in world.models]
    assert labels == [[1, 3, 1, 3], [2, 3], [None, 3]]
    assert not world.warnings


def test_what_has_no_effect_on_a_link_is_named():
    world = sdf.parse(
        """<sdf version="1.6"><world name="w"><model name="m"><link name="l">
<projector name="p"/>
<visual name="v"><geometry><sphere/></geometry>
<plugin name="blink" filename="libBlinkVisualPlugin.so"/></visual></link></model></world></sdf>""",
        "w.sdf",
    )
    assert world.warnings == (
        'w.sdf:2: <projector name="p">: has no effect, left out',
        'w.sdf:4: <plugin name="blink">: plugins of visuals (libBlinkVisualPlugin.so) have no effect, left out',
    )


def test_a_road_is_named_as_it_is_not_drawn():
    world = sdf.parse('<sdf version="1.5"><world name="w"><road name="r"/></world></sdf>', "w.sdf")
    assert world.warnings == ('w.sdf:1: <road name="r">: has no effect, left out',)


def test_an_actor_can_be_included(tmp_path):
    (tmp_path / "walker").mkdir()
    (tmp_path / "walker/model.sdf").write_text(
        "<sdf version='1.6'><actor name='walker'><pose>0 0 1 0 0 0</pose><link name='body'/>"
        "<plugin name='p' filename='libp.so'/></actor></sdf>"
    )
    uri = "<uri>model://walker</uri>"
    extra = "<name>guide</name><pose>1 0 0 0 0 0</pose><plugin name='q' filename='libq.so'/>"
    first, second = included(tmp_path, f"<include>{uri}</include><include>{uri}{extra}</include>").actors
    assert (first.name, first.pose.position) == ("walker", (0, 0, 1))
    assert (second.name, second.model.name, second.pose.position) == ("guide", "guide", (1, 0, 0))
    assert [plugin.filename for plugin in second.model.plugins] == ["libp.so", "libq.so"]


def test_a_model_found_takes_the_name_of_one_that_is_missing(tmp_path):
    text = '<include><uri>model://chair</uri></include><model name="chair"><link name="body"/></model>'
    text += '<joint name="hold" type="fixed"><parent>world</parent><child>chair</child></joint>'
    world = included(tmp_path, text)
    assert [model.name for model in world.models] == ["chair"]
    assert list(world.joints) == ["hold"]


def test_a_model_that_is_spawned_needs_all_of_its_parts(tmp_path):
    text = '<sdf version="1.9"><model name="m"><include><uri>model://chair</uri></include></model></sdf>'
    with pytest.raises(DescriptionError, match="model://chair not found"):
        sdf.parse_model(text, str(tmp_path / "m.sdf"), model_path=[])
    with pytest.raises(DescriptionError, match="model://chair not found"):
        sdf.parse_any(text.replace("<model name", "<light name='l'/><model name"), "m.sdf", model_path=[])


def test_downloads_of_gazebo_fuel_are_found(tmp_path, monkeypatch):
    monkeypatch.setenv("GZ_FUEL_CACHE_PATH", str(tmp_path / "fuel"))
    for version, name in ((2, "two"), (10, "ten")):
        folder = tmp_path / f"fuel/fuel.gazebosim.org/some one/models/tall lamp/{version}"
        folder.mkdir(parents=True)
        (folder / "model.sdf").write_text(
            f"<sdf version='1.9'><model name='{name}'><link name='l'><visual name='v'><geometry><mesh>"
            "<uri>https://fuel.ignitionrobotics.org/1.0/Some One/models/Tall%20Lamp/tip/files/lamp.stl</uri>"
            "</mesh></geometry></visual></link></model></sdf>"
        )
        (folder / "lamp.stl").write_text("solid\nendsolid\n")
    address = "https://fuel.ignitionrobotics.org/1.0/Some One/models/Tall Lamp"
    for tail, name in (("", "ten"), ("/2", "two"), ("/tip", "ten"), ("\n  ", "ten")):
        (model,) = included(tmp_path, f"<include><uri>{address}{tail}</uri></include>", strict=True).models
        assert model.name == name
        assert model.links["l"].visuals[0].geometry.path == folder / "lamp.stl"


def test_models_of_gazebo_fuel_are_found_among_the_users(tmp_path):
    folder = tmp_path / "Tall Lamp"
    folder.mkdir()
    (folder / "model.sdf").write_text("<sdf version='1.9'><model name='mine'/></sdf>")
    include = "<include><uri>https://fuel.gazebosim.org/1.0/owner/models/Tall Lamp</uri></include>"
    assert [model.name for model in included(tmp_path, include, strict=True).models] == ["mine"]


def test_a_joint_may_be_called_as_a_link():
    world = sdf.parse(
        """<sdf version="1.5"><world name="w"><model name="lift">
<link name="car"/><link name="door"><pose>1 0 0 0 0 0</pose></link>
<joint name="door" type="prismatic"><pose>0 3 0 0 0 0</pose><parent>car</parent><child>door</child>
<axis><xyz>0 1 0</xyz></axis></joint></model></world></sdf>""",
        "w.sdf",
    )
    (lift,) = world.models
    assert lift.links["door"].pose.position == (1, 0, 0)
    assert lift.joints["door"].origin.position == (1, 3, 0)
    assert "w.sdf:3: <joint name=\"door\">: a link is called 'door' as well" in world.warnings[0]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("<world name", "<word name", "expected <world>, <model>, <light> or <actor>"),
        ("<mass>3</mass>", "<mass>-3</mass>", "mass should not be negative"),
        ("<radius>2</radius>", "<radius>big</radius>", r"w.sdf:\d+: <radius>: the text should be a number"),
        ("<child>wheel</child>", "<child>weel</child>", "there is no link 'weel'"),
        ("<parent>body</parent>", "<parent>wheel</parent>", "parent and child are the same"),
        ('type="revolute"', 'type="rotary"', "unknown joint type 'rotary'"),
        ("<max_step_size>0.002", "<max_step_size>-1", "expected a step between 0 and 1 s"),
        ("<xyz>0 1 0</xyz>", "<xyz>0 0 0</xyz>", "no direction"),
        ("<update_rate>100", "<update_rate>-1", "should not be negative"),
        ("<size>1 2 3</size>", "<size>1 2</size>", "should be 3 numbers"),
        ("</world>", "", "mismatched tag"),
    ],
)
def test_mistakes_are_named(old, new, words):
    assert old in WORLD
    text = WORLD.replace(old, new).replace("</world>", "</word>" if "<word " in new else "</world>")
    with pytest.raises(DescriptionError, match=words):
        sdf.parse(text, "w.sdf")


def test_files(tmp_path):
    with pytest.raises(DescriptionError, match="no such file"):
        sdf.load(tmp_path / "no.world")
    folder_of_models(tmp_path)
    assert sdf.load_model(tmp_path / "arm").name == "arm"
    assert [model.name for model in sdf.load(tmp_path / "arm/new.sdf").models] == ["arm"]
    with pytest.raises(DescriptionError, match="expected <model>"):
        sdf.parse_model("<sdf version='1.9'/>")
    with pytest.raises(DescriptionError, match="expected <sdf>"):
        sdf.parse("<robot/>")


@pytest.mark.parametrize("name", ["arena", "hexagon"])
def test_our_worlds_load(name):
    world = sdf.load(SHARE / f"turtlebot3_gazebo/worlds/{name}.world")
    assert world.name == name
    assert all(model.static for model in world.models)
    assert not world.warnings


@examples(200)
@given(st.data())
def test_damaged_worlds_give_worlds_or_descriptions_errors(data):
    root = parse_markup(WORLD)
    element = data.draw(st.sampled_from(list(root.walk())))
    if element.children and data.draw(st.booleans()):
        element.children.remove(data.draw(st.sampled_from(element.children)))
    elif element.attributes and data.draw(st.booleans()):
        key = data.draw(st.sampled_from(sorted(element.attributes)))
        element.attributes[key] = data.draw(st.text(st.characters(codec="ascii", categories=["L", "N", "P"])))
    else:
        element.text = data.draw(st.text(st.characters(codec="ascii", categories=["L", "N", "P", "Zs"])))
    problem = problem_of(lambda: sdf.parse(root.to_text(), "w.sdf"))
    assert problem is None or problem.startswith(("w.sdf", str(BUILT_IN_MODELS)))
    assert problem is None or "\n" not in problem


def one_model(inside, version="1.9", attributes=""):
    return sdf.parse(
        f"<sdf version='{version}'>\n<world name='w'><model name='m' {attributes}>{inside}</model></world></sdf>",
        "w.sdf",
    )


@pytest.mark.parametrize(
    ("document", "line", "words"),
    [
        ("<sdf version='99.1'><world name='w'/></sdf>", 1, "version 99.1 is newer than"),
        ("<sdf version='two'><world name='w'/></sdf>", 1, "version 'two' is not like"),
        ("<sdf><world name='w'/></sdf>", 1, 'attribute "version" is missing'),
        ("<sdf version='1.9'>\n<world/></sdf>", 2, 'attribute "name" is missing'),
        ("<sdf version='1.9'><world name='w'/>\n<world name='x'/></sdf>", 2, "only the first world counts"),
    ],
)
def test_what_gazebo_complains_of_is_warned_of(document, line, words):
    (warning,) = sdf.parse(document, "w.sdf").warnings
    assert warning.startswith(f"w.sdf:{line}: ")
    assert words in warning


def test_the_frame_of_a_nested_model_and_its_own_place_it():
    nested = "<model name='n' {}><pose>1 0 0 0 0 0</pose><link name='l'/></model>"
    frame = "<frame name='f' attached_to='n::__model__'><pose>0 2 0 0 0 0</pose></frame>"
    joint = "<joint name='j' type='fixed'><parent>a</parent><child>n::__model__</child></joint>"
    world = one_model("<link name='a'/>" + nested.format("placement_frame='__model__'") + frame + joint)
    (model,) = world.models
    assert model.frames["f"].position == (1, 2, 0)
    assert model.joints["j"].child == "n::l"


def test_the_second_axis_of_a_universal_joint_has_a_default():
    links = "<link name='a'/><link name='b'/>"
    ends = "<parent>a</parent><child>b</child>"
    joint = "<joint name='j' type='universal'>{}<axis><xyz>{}</xyz></axis></joint>"
    for first, second in (("0 0 1", (0, 1, 0)), ("0 1 0", (1, 0, 0))):
        (model,) = one_model(links + joint.format(ends, first)).models
        assert model.joints["j"].axes[1].xyz == second


def test_a_shape_without_geometry_is_empty():
    world = one_model("<link name='a'>\n<visual name='v'/><collision name='c'/></link>")
    assert world.models[0].links["a"].visuals[0].geometry == Empty()
    assert [warning.split(": ")[0] for warning in world.warnings] == ["w.sdf:3", "w.sdf:3"]


def test_a_frame_may_be_called_as_a_model_before_sdf_1_7():
    inside = "<model name='g'><link name='l'/></model>\n<frame name='g'><pose>0 0 3 0 0 0</pose></frame>"
    old = sdf.parse(f"<sdf version='1.6'><world name='w'>{inside}</world></sdf>", "w.sdf")
    assert old.frames["g_frame"].position == (0, 0, 3)
    with pytest.raises(DescriptionError, match=r"w\.sdf:2: .*the name 'g' is used before"):
        sdf.parse(f"<sdf version='1.7'><world name='w'>{inside}</world></sdf>", "w.sdf")


def test_an_unknown_canonical_link_is_named():
    with pytest.raises(DescriptionError, match=r"w\.sdf:2: .*canonical_link 'b' is not in the model"):
        one_model("<link name='a'/>", attributes="canonical_link='b'")


def test_frames_inside_a_model_that_is_not_found_are_where_it_is():
    world = sdf.parse(
        "<sdf version='1.9'><world name='w'><include><uri>model://nowhere</uri><name>n</name><pose>1 0 0 0 0 0</pose>"
        "</include><model name='m'><pose relative_to='n::a::b'>0 2 0 0 0 0</pose><link name='l'/></model></world>"
        "</sdf>",
        "w.sdf",
        model_path=(),
        strict=False,
    )
    assert world.models[0].pose.position == (1, 2, 0)


NESTED_STATIC = "<model name='wall'><static>{static}</static><link name='l'/></model>"


@pytest.mark.parametrize(
    ("inside", "whole", "links"),
    [
        (NESTED_STATIC.format(static=1), True, {"wall::l": True}),
        (NESTED_STATIC.format(static=0), False, {"wall::l": False}),
        (NESTED_STATIC.format(static=1) + "<link name='own'/>", False, {"wall::l": True, "own": False}),
        (f"<model name='deep'>{NESTED_STATIC.format(static=1)}</model>", True, {"deep::wall::l": True}),
    ],
)
def test_nested_models_are_static_by_themselves(inside, whole, links):
    model = one_model(inside).models[0]
    assert model.static is whole
    assert {name: link.static for name, link in model.links.items()} == links
