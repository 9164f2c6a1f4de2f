import numpy as np
import pytest

from daidalos.common.pose3 import Pose
from daidalos.simulation import Simulation, scenery
from simulation.models import box, world

SECOND = 1_000_000_000


def _shape(index, kind, pose, static):
    """Return the SDF of a model of a shape."""
    shapes = {
        "box": "<box><size>0.6 0.3 0.4</size></box>",
        "cylinder": "<cylinder><radius>0.2</radius><length>0.5</length></cylinder>",
        "sphere": "<sphere><radius>0.25</radius></sphere>",
    }
    return (
        f"<model name='m{index}'><static>{str(static).lower()}</static><pose>{pose}</pose><link name='link'>"
        f"<collision name='shape'><geometry>{shapes[kind]}</geometry></collision></link></model>"
    )


def _clutter(seed):
    """Return a world of static shapes in all orientations, with some that fall on them."""
    random = np.random.default_rng(seed)
    parts = []
    for index in range(16):
        place, turn = random.uniform(-2.0, 2.0, 2), random.uniform(-3.0, 3.0, 3)
        static = index >= 4
        height = 0.4 if static else 1.5
        pose = " ".join(f"{value:.3f}" for value in (*place, height, *turn))
        parts.append(_shape(index, str(random.choice(["box", "cylinder", "sphere"])), pose, static))
    return world(*parts)


def _run(description, drive):
    """Return the bits of all positions over time, and the touching pairs."""
    simulation = Simulation(description)
    bits, pairs = [], set()
    for step in range(100):
        drive(simulation, step)
        pairs |= {frozenset((contact.model1, contact.model2)) for contact in simulation.contacts()}
        simulation.advance(SECOND // 100)
        bits.append(simulation.physics.data.qpos.tobytes())
    return bits, pairs


def _with_and_without(monkeypatch, description, drive):
    filtered = _run(description, drive)
    monkeypatch.setattr(scenery, "MIN_BODIES", 1000)
    return filtered, _run(description, drive)


def _throw(simulation, step):
    """Throw, move and push things in turn."""
    random = np.random.default_rng(step)
    model = f"m{step % 4}"
    if step % 25 == 20:
        simulation.set_velocity(model, random.uniform(-60.0, 60.0, 3), np.zeros(3))
    elif step % 25 == 10:
        simulation.set_pose(model, Pose((*random.uniform(-2.0, 2.0, 2), 0.5)))
    elif step % 25 == 5:
        simulation.push(model, force=(3e4, 0.0, 0.0), duration_ns=2_000_000)


@pytest.mark.parametrize("seed", range(3))
def test_bodies_move_as_with_all_static_bodies_in_collision_detection(monkeypatch, seed):
    filtered, whole = _with_and_without(monkeypatch, _clutter(seed), _throw)
    assert any("ground_plane" not in pair for pair in whole[1])
    assert filtered == whole


def test_only_static_bodies_near_what_moves_take_part():
    rows = [box(f"wall{index}", f"{index} 0 0.5 0 0 0", "0.1 1 1", static=True) for index in range(2, 8)]
    simulation = Simulation(world(box("moving"), *rows))

    def taking_part():
        simulation.advance(SECOND // 100)
        model = simulation.physics.model
        return [i for i in range(2, 8) if model.body_contype[model.body(f"wall{i}::link").id]]

    assert taking_part() == []
    simulation.set_pose("moving", Pose((4.5, 0.0, 0.5)))
    assert taking_part() == [4, 5]
    simulation.set_pose("moving", Pose((-9.0, 0.0, 0.5)))
    assert taking_part() == []


def test_contacts_of_a_model_are_those_of_its_new_place():
    walls = [box(f"wall{index}", f"{3 * index} 0 0.5 0 0 0", static=True) for index in range(1, 6)]
    simulation = Simulation(world(box("moving", "0 0 0.5 0 0 0"), *walls))
    simulation.advance(SECOND // 10)
    simulation.set_pose("moving", Pose((9.2, 0.0, 0.5)))
    assert "wall3" in {name for contact in simulation.contacts() for name in (contact.model1, contact.model2)}


@pytest.mark.parametrize("acceleration", [0.0, 2000.0])
def test_fast_bodies_touch_what_they_were_far_from(monkeypatch, acceleration):
    ahead = 10.0 if acceleration else 2.0
    walls = [box(f"wall{index}", f"{ahead + 3 * index} 0 0.5 0 0 0", static=True) for index in range(4)]

    def throw(simulation, step):
        if step == 1 and acceleration:
            simulation.push("moving", force=(acceleration, 0.0, 0.0), duration_ns=SECOND // 2)
        elif step == 1:
            simulation.set_velocity("moving", (200.0, 0.0, 0.0), np.zeros(3))

    filtered, whole = _with_and_without(monkeypatch, world(box("moving"), *walls), throw)
    assert filtered == whole
