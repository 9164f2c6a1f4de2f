"""Models that are added to a world, compiled and taken out again."""

import pytest

from daidalos.common.pose3 import Pose
from daidalos.description.world import World
from daidalos.simulation.compilation import Compilation
from daidalos.simulation.errors import SimulationError
from simulation.models import box, world


def boxes(*names):
    described = world(*(box(name, "0 0 5 0 0 0") for name in names))
    return [model for model in described.models if model.name in names]


def compilation():
    return Compilation(
        World(), 1e-3, has_subscribers=lambda topic: True, can_draw=lambda topic, now: True, warn=pytest.fail
    )


def test_there_are_no_physics_before_the_first_compilation():
    with pytest.raises(SimulationError, match="not compiled"):
        _ = compilation().physics


def test_what_stays_keeps_its_state_while_others_come_and_go():
    compiled = compilation()
    first, second = boxes("first", "second")
    falling = compiled.add(first, first.pose, "", [])
    compiled.compile()
    compiled.physics.step(100)
    height = falling.pose.position[2]
    speed = falling.link("link").velocity()[0][2]
    assert height < 5
    assert speed < 0

    other = compiled.add(second, Pose((3.0, 0.0, 1.0)), "", [])
    compiled.recompile()
    assert falling.pose.position[2] == height
    assert falling.link("link").velocity()[0][2] == speed
    assert other.pose.position == (3.0, 0.0, 1.0)

    compiled.remove(falling)
    compiled.recompile()
    assert list(compiled.instances) == ["second"]
    assert compiled.physics.model.nbody == 2
    assert compiled.number == 3


def test_what_can_not_be_compiled_is_told_in_one_line():
    compiled = compilation()
    (model,) = boxes("b")
    compiled.add(model, model.pose, "", [])
    compiled.spec.add_actuator(name="a", target="nothing")
    with pytest.raises(SimulationError) as told:
        compiled.compile()
    assert "\n" not in str(told.value)
    assert not str(told.value).startswith("Error")
