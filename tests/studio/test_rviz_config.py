"""RViz's display configurations as the studio reads them."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.studio.arrangement import ArrangementError, Display
from daidalos.studio.rviz_config import read_rviz

ROS_2 = """
Panels:
  - Class: rviz_common/Displays
Visualization Manager:
  Class: ""
  Displays:
    - {Alpha: 0.5, Cell Size: 2, Class: rviz_default_plugins/Grid, Color: 160; 160; 164, Enabled: true, Name: Grid,
       Plane Cell Count: 10, Value: true}
    - Class: rviz_common/Group
      Enabled: false
      Name: Navigation
      Displays:
        - Class: rviz_default_plugins/Map
          Color Scheme: costmap
          Draw Behind: true
          Enabled: true
          Name: Costmap
          Topic: {Depth: 5, Durability Policy: Transient Local, Value: /global_costmap/costmap}
    - Class: rviz_default_plugins/LaserScan
      Color: 255; 0; 0
      Color Transformer: FlatColor
      Decay Time: 0
      Name: LaserScan
      Size (m): 0.01
      Size (Pixels): 3
      Style: Flat Squares
      Topic: {Value: /scan}
      Enabled: true
    - {Class: rviz_default_plugins/Image, Name: Image, Topic: {Value: /camera/image_raw}, Enabled: true}
    - {Class: nav2_rviz_plugins/ParticleCloud, Name: Particles, Enabled: true}
  Global Options: {Background Color: 48; 48; 48, Fixed Frame: odom, Frame Rate: 30}
  Views:
    Current: {Class: rviz_default_plugins/Orbit, Distance: 12, Pitch: 0.6, Yaw: 1.5, Target Frame: <Fixed Frame>,
      Focal Point: {X: 1, Y: 2, Z: 0.5}}
"""
ROS_1 = """
Visualization Manager:
  Displays:
    - {Class: rviz/Image, Image Topic: /usb_cam/image_raw, Name: Image, Enabled: false, Value: false}
    - {Class: rviz/MarkerArray, Marker Topic: visualization_marker_array, Name: Markers, Value: true}
    - {Class: rviz/Odometry, Topic: /odom, Name: Odometry, Enabled: true, Keep: 50, Shape: {Color: 0; 255; 0}}
  Global Options: {Fixed Frame: map}
  Views:
    Current: {Class: rviz/TopDownOrtho, Scale: 80, X: 3, Y: -1, Target Frame: base_link}
"""


def read(tmp_path, text):
    file = tmp_path / "view.rviz"
    file.write_text(text)
    return read_rviz(file)


def test_displays_of_ros_2(tmp_path):
    arrangement = read(tmp_path, ROS_2)
    assert arrangement.fixed_frame == "odom"
    grid, costmap, scan, image, particles = arrangement.displays
    assert grid == Display("Grid", "Grid", True, {"cells": 10.0, "size": 2.0, "alpha": 0.5, "color": "#a0a0a4"}, "0")
    assert image == Display("Image", "Image", True, {"topic": "/camera/image_raw"}, "3")
    assert particles == Display("nav2_rviz_plugins/ParticleCloud", "Particles", True, {}, "4"), "it stays in the list"
    assert (costmap.name, costmap.enabled) == ("Navigation/Costmap", False), "its group is switched off"
    assert costmap.settings == {"topic": "/global_costmap/costmap", "scheme": "costmap", "layer": "behind"}
    assert scan.settings == {
        "topic": "/scan", "colorBy": "flat", "style": "squares", "pixels": 3.0, "metres": 0.01, "decay": 0.0,
        "color": "#ff0000",
    }  # fmt: skip
    assert arrangement.left_out == ("Particles (nav2_rviz_plugins/ParticleCloud)",)
    view = arrangement.view
    assert (view.kind, view.focus, view.distance, view.yaw, view.pitch) == ("orbit", (1, 2, 0.5), 12, 1.5, 0.6)
    assert arrangement.followed == ""
    assert json.loads(json.dumps(arrangement.to_json()))["displays"][0]["type"] == "Grid"


def test_displays_of_ros_1(tmp_path):
    arrangement = read(tmp_path, ROS_1)
    image, markers, odometry = arrangement.displays
    assert (image.enabled, image.settings) == (False, {"topic": "/usb_cam/image_raw"})
    assert markers == Display("MarkerArray", "Markers", True, {"topic": "/visualization_marker_array"}, "1")
    assert odometry.settings == {"topic": "/odom", "keep": 50.0, "color": "#00ff00"}
    assert (arrangement.view.kind, arrangement.view.focus) == ("top", (3, -1, 0))
    assert arrangement.followed == "base_link"


def test_panels_of_plugins_that_the_page_has_are_opened(tmp_path):
    displays = "  - Class: rviz_common/Displays\n"
    text = ROS_2.replace(displays, f"{displays}  - Class: slam_toolbox::SlamToolboxPlugin\n  - 3\n")
    assert read(tmp_path, text).panels == ("slam_toolbox",)


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("Panels: []", "view.rviz: not a display configuration: 'Visualization Manager' is missing"),
        ("- 1\n- [", "view.rviz:2: not YAML"),
        ("just words", "'Visualization Manager' is missing"),
    ],
)
def test_mistakes_are_named(tmp_path, text, error):
    with pytest.raises(ArrangementError, match=error.replace("[", r"\[")):
        read(tmp_path, text)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inside: st.lists(inside, max_size=3) | st.dictionaries(st.sampled_from(["Value", "Class", "Z"]), inside),
    max_leaves=6,
)
KEYS = st.sampled_from(["Class", "Name", "Topic", "Color", "Alpha", "Offset", "Displays", "Enabled", "Shape", "Style"])
CLASSES = st.sampled_from(["Path", "Group", "Odometry", "Image", "Grid"])


@given(st.dictionaries(KEYS, VALUES), CLASSES, VALUES)
def test_whatever_stands_in_a_display_is_no_traceback(tmp_path_factory, node, kind, current):
    document = {"Visualization Manager": {"Displays": [{**node, "Class": f"rviz/{kind}"}], "Views": current}}
    file = tmp_path_factory.getbasetemp() / "any.rviz"
    file.write_text(json.dumps(document))
    json.dumps(read_rviz(file).to_json())
