import numpy as np
import pytest
import shapely

from daidalos.description import sdf
from daidalos.description.footprint import footprint
from description.robots import SHARE

TRIANGLE = "<polyline><point>0 0</point><point>3 0</point><point>0 2</point><height>1</height></polyline>"


def world(*models):
    return sdf.parse(f"<sdf version='1.9'><world name='w'>{''.join(models)}</world></sdf>")


def model(shape, pose="0 0 0 0 0 0", static=True):
    return (
        f"<model name='m'><static>{'true' if static else 'false'}</static><link name='l'><collision name='c'>"
        f"<pose>{pose}</pose><geometry>{shape}</geometry></collision></link></model>"
    )


def test_a_turned_box_covers_the_cells_in_it():
    plan = footprint(world(model("<box><size>2 1 1</size></box>", "1 2 0 0 0 0.5")), 0.2, 0.05)
    corners = np.array([(1, 0.5), (-1, 0.5), (-1, -0.5), (1, -0.5)])
    turn = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]])
    outline = shapely.Polygon(corners @ turn.T + (1, 2))
    rows, columns = np.indices(plan.occupied.shape)
    x = plan.origin[0] + (columns + 0.5) * 0.05
    y = plan.origin[1] + (rows + 0.5) * 0.05
    np.testing.assert_array_equal(plan.occupied, shapely.contains_xy(outline, x, y))


@pytest.mark.parametrize(
    ("shape", "pose", "height", "area"),
    [
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", "0 0 0.5 0 0 0", 0.3, np.pi / 4),
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", "0 0 0.5 0 0 0", 1.3, 0),
        ("<sphere><radius>1</radius></sphere>", "0 0 0 0 0 0", 0.6, np.pi * 0.64),
        (TRIANGLE, "0 0 0 0 0 0", 0.5, 3),
        ("<plane><normal>0 0 1</normal></plane>", "0 0 0 0 0 0", 0.0, 0),
    ],
)
def test_areas_of_cuts(shape, pose, height, area):
    plan = footprint(world(model(shape, pose)), height, 0.01)
    assert plan.occupied.sum() * 1e-4 == pytest.approx(area, rel=0.01, abs=1e-3)


def test_only_what_is_static_counts():
    plan = footprint(world(model("<box><size>1 1 1</size></box>", static=False)), 0.1)
    assert not plan.occupied.any()


def test_what_can_be_seen_from_inside_a_room():
    walls = "".join(
        model(f"<box><size>{w} {d} 1</size></box>", f"{x} {y} 0 0 0 0").replace("'m'", f"'m{x}{y}'")
        for x, y, w, d in ((2, 0, 0.4, 4.4), (-2, 0, 0.4, 4.4), (0, 2, 4.4, 0.4), (0, -2, 4.4, 0.4))
    )
    plan = footprint(world(walls), 0.2, 0.1)
    free = plan.reachable(0, 0)
    assert free.sum() == 36 * 36
    seen = plan.visible_walls(0, 0)
    assert seen.sum() == 38 * 38 - 36 * 36
    assert not plan.reachable(2, 0).any()
    assert not plan.reachable(50, 0).any()


@pytest.mark.parametrize("name", ["arena", "hexagon"])
def test_the_worlds_are_closed_rooms_with_a_free_start(name):
    plan = footprint(sdf.load(SHARE / f"turtlebot3_gazebo/worlds/{name}.world"), 0.132)
    free = plan.reachable(0, 0)
    assert free.any()
    border = np.concatenate((free[0], free[-1], free[:, 0], free[:, -1]))
    assert not border.any()
    row, column = plan.cell(0, 0)
    reach = int(0.5 / plan.resolution)
    assert not plan.occupied[row - reach : row + reach, column - reach : column + reach].any()
