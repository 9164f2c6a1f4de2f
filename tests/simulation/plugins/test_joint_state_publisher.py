import pytest

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


def test_joints_that_do_not_exist_or_do_not_move_are_not_published():
    parameters = "".join(f"\n<joint_name>{name}</joint_name>" for name in ("elbow", "to_world", "hinge"))
    pendulum = PENDULUM.format("libgazebo_ros_joint_state_publisher.so", parameters)
    simulation = Simulation(world(pendulum), warn=lambda line: None)
    assert [line.split(": ")[0] for line in simulation.warnings] == ["w.sdf:7", "w.sdf:8"]
    assert "no joint 'elbow'" in simulation.warnings[0]
    assert "'to_world' is fixed" in simulation.warnings[1]
    assert simulation.advance(100_000_000)[0].names == ("hinge",)
