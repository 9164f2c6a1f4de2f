"""Display configurations that the page saves: RViz reads them, and finds in them what the page does not know."""

from dataclasses import replace

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from daidalos.studio.arrangement import ArrangementError, Display, View
from daidalos.studio.rviz_config import SETTINGS, parse_rviz
from daidalos.studio.rviz_writing import RvizState, write_rviz

from .test_rviz_config import ROS_1, ROS_2

WINDOW = """
Window Geometry:
  Displays: {collapsed: false}
  Height: 846
  QMainWindow State: 000000ff00000000fd000000040000000000000156000002b0fc0200000008fb
  Width: 0x4b0
"""


def state_of(source, **changes):
    read = parse_rviz(source, "a.rviz")
    return replace(RvizState(read.fixed_frame, read.displays, read.view, read.followed, source), **changes)


def scalars(text):
    """The document with every value as it is written."""
    return yaml.load(text, yaml.BaseLoader)


@pytest.mark.parametrize("source", [ROS_2 + WINDOW, ROS_1 + WINDOW])
def test_what_was_not_changed_stays_as_it_was_written(source):
    assert scalars(write_rviz(state_of(source))) == scalars(source)


def test_changes_are_written_where_the_file_has_them():
    state = state_of(ROS_2 + WINDOW)
    grid, costmap, scan, image, particles = state.displays
    displays = (
        replace(grid, settings={**grid.settings, "color": "#ff8000", "cells": 20.0}),
        replace(scan, name="Front", enabled=False, settings={**scan.settings, "topic": "/front", "style": "points"}),
        particles,
        Display("RobotModel", "Robot", True, {"topic": "/robot_description", "alpha": 0.5}),
    )
    view = View("top", (1.0, 2.0, 0.0), 9.0)
    text = write_rviz(replace(state, displays=displays, fixed_frame="map", view=view, followed="base_link"))
    manager = yaml.safe_load(text)["Visualization Manager"]
    first, group, front, unknown, robot = manager["Displays"]
    assert (first["Color"], first["Plane Cell Count"], first["Alpha"]) == ("255; 128; 0", 20, 0.5)
    assert group["Displays"] == [], "the costmap was removed"
    assert (front["Name"], front["Enabled"], front["Value"], front["Style"]) == ("Front", False, False, "Points")
    assert front["Topic"] == {"Value": "/front"}
    assert unknown["Class"] == "nav2_rviz_plugins/ParticleCloud"
    assert robot["Class"] == "rviz_default_plugins/RobotModel"
    assert robot["Description Topic"]["Value"] == "/robot_description"
    assert manager["Global Options"] == {"Background Color": "48; 48; 48", "Fixed Frame": "map", "Frame Rate": 30}
    current = manager["Views"]["Current"]
    assert (current["Class"], current["X"], current["Target Frame"]) == (
        "rviz_default_plugins/TopDownOrtho",
        1.0,
        "base_link",
    )
    again = parse_rviz(text, "b.rviz")
    assert (again.view.kind, again.view.focus) == ("top", view.focus)
    assert again.view.distance == pytest.approx(9.0)
    assert costmap not in again.displays
    assert image not in again.displays


def test_a_display_that_is_turned_on_in_a_group_that_is_off_turns_the_group_on():
    source = """
Visualization Manager:
  Displays:
    - Class: rviz_common/Group
      Enabled: false
      Displays:
        - {Class: rviz_default_plugins/Path, Name: One, Enabled: true, Value: true}
        - {Class: rviz_default_plugins/Path, Name: Two, Enabled: true, Value: true}
"""
    state = state_of(source)
    one, two = state.displays
    assert (one.enabled, two.enabled) == (False, False)
    again = parse_rviz(write_rviz(replace(state, displays=(replace(one, enabled=True), two))), "b.rviz")
    assert [each.enabled for each in again.displays] == [True, False]


def test_a_new_configuration_has_the_panels_and_tools_that_rviz_has():
    scan = Display(
        "LaserScan", "Scan", True, {"topic": "/scan", "style": "squares", "metres": 0.02, "color": "#ff0000"}
    )
    text = write_rviz(RvizState("odom", (scan,), View("orbit", (0.0, 0.0, 0.0), 5.0, 0.5, 0.6)))
    document = yaml.safe_load(text)
    assert [panel["Class"] for panel in document["Panels"]] == ["rviz_common/Displays", "rviz_common/Views"]
    manager = document["Visualization Manager"]
    assert {"rviz_default_plugins/SetGoal", "rviz_default_plugins/MoveCamera"} <= {
        tool["Class"] for tool in manager["Tools"]
    }
    (written,) = manager["Displays"]
    assert written["Topic"]["Durability Policy"] == "Volatile"
    assert (written["Style"], written["Size (m)"], written["Color"]) == ("Flat Squares", 0.02, "255; 0; 0")
    again = parse_rviz(text, "new.rviz")
    assert again.fixed_frame == "odom"
    assert again.displays[0].settings == scan.settings
    assert again.view == View("orbit", (0.0, 0.0, 0.0), 5.0, 0.5, 0.6)


def test_a_source_that_is_none_is_named():
    with pytest.raises(ArrangementError, match="'Visualization Manager' is missing"):
        write_rviz(RvizState("map", (), source="Panels: []"))


NUMBERS = st.floats(0.01, 100).map(lambda value: round(value, 3))
PLAIN = {entry.key for entries in SETTINGS.values() for entry in entries if entry.key in ("pixels", "metres", "decay")}


@pytest.mark.slow
@given(
    st.sampled_from(sorted(SETTINGS)),
    st.dictionaries(st.sampled_from(sorted({*PLAIN, "alpha"})), NUMBERS),
    st.booleans(),
)
def test_numbers_are_read_back_as_they_were_saved(kind, settings, enabled):
    known = {entry.key for entry in SETTINGS[kind]} | {"alpha"}
    settings = {key: value for key, value in settings.items() if key in known}
    saved = Display(kind, "One", enabled, settings)
    (again,) = parse_rviz(write_rviz(RvizState("map", (saved,))), "a.rviz").displays
    assert again == replace(saved, origin="0")
