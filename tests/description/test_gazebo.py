import pytest

from daidalos.common.pose3 import Pose
from daidalos.description import urdf
from daidalos.description.gazebo import model_from_robot
from description.robots import ARM

EXTRA = """
  <gazebo><plugin name="p" filename="libp.so"><x>1</x></plugin><static>true</static></gazebo>
  <gazebo reference="fore">
    <material>Gazebo/Orange</material><mu1 value="0.1"/><mu2>0.2</mu2><turnGravityOff>1</turnGravityOff>
    <sensor name="s" type="imu"><pose>1 2 3 0 0 0</pose><update_rate>50</update_rate></sensor>
  </gazebo>
  <gazebo reference="nowhere"/>
</robot>"""


@pytest.fixture
def model():
    shape = '<link name="fore"><visual><geometry><sphere radius="1"/></geometry></visual><collision><geometry>'
    text = ARM.replace('<link name="fore"/>', f'{shape}<sphere radius="1"/></geometry></collision></link>')
    return model_from_robot(urdf.parse(text.replace("</robot>", EXTRA)))


def test_links_are_placed_by_the_joints(model):
    assert model.links["fore"].pose.position == pytest.approx((0, 1, 1))
    assert model.frames["elbow"].position == pytest.approx((0, 1, 1))


def test_extensions_become_part_of_the_model(model):
    fore = model.links["fore"]
    assert fore.visuals[0].material.color == (0.98, 0.5, 0.04, 1)
    surface = fore.collisions[0].surface
    assert (surface.mu, surface.mu2) == (0.1, 0.2)
    assert fore.collisions[0].name == "fore_collision"
    assert not fore.gravity
    assert fore.sensors[0].pose == Pose((1, 2, 3))
    assert fore.sensors[0].update_rate == 50
    assert model.static
    assert [plugin.name for plugin in model.plugins] == ["p"]
    assert model.links["upper"].self_collide is True
    assert model.links["upper"].gravity
    assert model.ros2_control


def test_a_reference_to_nothing_is_noted(model):
    assert len(model.warnings) == 1
    assert "refers to 'nowhere'" in model.warnings[0]


def test_a_root_called_world_is_the_world():
    model = model_from_robot(urdf.parse(ARM.replace('"base"', '"world"')))
    assert "world" not in model.links
    assert model.joints["shoulder"].parent == "world"
