import pytest

from daidalos.description.errors import DescriptionError
from daidalos.simulation import Simulation
from simulation.models import world

PENDULUM = """<model name='p'><link name='base'/><link name='bob'>
  <pose>0 0 1 0 0 0</pose><inertial><pose>0 0 -0.5 0 0 0</pose></inertial></link>
  <joint name='to_world' type='fixed'><parent>world</parent><child>base</child></joint>
  <joint name='hinge' type='revolute'><parent>base</parent><child>bob</child>
  <axis><xyz>0 1 0</xyz></axis></joint>
  <plugin name='j' filename='{}'>{}</plugin></model>"""


@pytest.mark.parametrize(
    ("filename", "parameters", "topic", "rate"),
    [
        ("libgazebo_ros_joint_state_publisher.so", "<jointName>hinge</jointName><updateRate>30</updateRate>",
         "/joint_states", 30),
        ("libgazebo_ros_joint_state_publisher.so", "<update_rate>50</update_rate>"
         "<joint_name>hinge</joint_name><ros><remapping>joint_states:=states</remapping></ros>",
         "/states", 50),
        ("gz-sim-joint-state-publisher-system", "", "/world/w/model/p/joint_state", 1000),
        ("gz-sim-joint-state-publisher-system", "<topic>js</topic>", "/js", 1000),
    ],
)  # fmt: skip
def test_dialects(filename, parameters, topic, rate):
    simulation = Simulation(world(PENDULUM.format(filename, parameters)))
    assert list(simulation.publications) == [topic]
    samples = simulation.advance(1_000_000_000)
    assert len(samples) == rate
    assert samples[-1].names == ("hinge",)
    hinge = simulation.joint("p", "hinge")
    assert samples[-1].positions.tolist() == [hinge.position]
    assert samples[-1].velocities.tolist() == [hinge.velocity]


def test_unknown_joint():
    parameters = "<joint_name>elbow</joint_name>"
    with pytest.raises(DescriptionError, match="no joint 'elbow'; known are to_world, hinge"):
        Simulation(world(PENDULUM.format("libgazebo_ros_joint_state_publisher.so", parameters)))
