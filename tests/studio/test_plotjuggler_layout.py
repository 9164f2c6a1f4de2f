"""PlotJuggler's layouts as the studio reads them."""

import pytest

from daidalos.studio.arrangement import ArrangementError, Curve, Plot, Split
from daidalos.studio.plotjuggler_layout import read_plotjuggler

LAYOUT = """<?xml version='1.0' encoding='UTF-8'?>
<root>
 <tabbed_widget name="Main Window" parent="main_window">
  <Tab tab_name="drive" containers="1">
   <Container>
    <DockSplitter orientation="-" count="2" sizes="0.25;0.75">
     <DockArea name="...">
      <plot mode="TimeSeries" style="Lines" flip_x="false" flip_y="false">
       <range left="0" right="10" top="1" bottom="-1"/>
       <curve name="/odom/twist/twist/linear/x" color="#1f77b4"/>
       <curve name="/joint_states/position[1]" color="#d62728"><transform name="Derivative" alias=""/></curve>
      </plot>
     </DockArea>
     <DockSplitter orientation="|" count="2" sizes="0.5;0.5">
      <DockArea name="..."><plot mode="XYPlot" style="Lines">
       <curve name="path" color="#2ca02c" curve_x="/odom/pose/pose/position/x" curve_y="/odom/pose/pose/position/y"/>
      </plot></DockArea>
      <DockArea name="..."><plot mode="TimeSeries"/></DockArea>
     </DockSplitter>
    </DockSplitter>
   </Container>
  </Tab>
  <Tab tab_name="empty" containers="0"/>
  <currentTabIndex index="0"/>
 </tabbed_widget>
 <customMathEquations><snippet name="speed"><function>return value</function></snippet></customMathEquations>
</root>
"""


def read(tmp_path, text):
    file = tmp_path / "plots.xml"
    file.write_text(text)
    return read_plotjuggler(file)


def test_plots_and_their_places(tmp_path):
    arrangement = read(tmp_path, LAYOUT)
    ((name, content),) = arrangement.tabs
    assert name == "drive"
    over_time = Plot(
        (Curve("/odom/twist/twist/linear/x", "#1f77b4"), Curve("/joint_states/position/1", "#d62728")),
        "0",
    )
    way = Plot((Curve("/odom/pose/pose/position/y", "#2ca02c", "/odom/pose/pose/position/x"),), "1")
    assert content == Split(False, (0.25, 0.75), (over_time, Split(True, (0.5, 0.5), (way, Plot((), "2")))))
    assert arrangement.left_out == (
        "the transform Derivative of /joint_states/position[1]",
        "the custom series speed",
    )


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("<root>\n<tabbed_widget>", r"plots.xml:2: "),
        ("<robot/>", r"plots.xml: not a layout of PlotJuggler"),
        ("plain text", r"plots.xml:1: "),
    ],
)
def test_mistakes_are_named(tmp_path, text, error):
    with pytest.raises(ArrangementError, match=error):
        read(tmp_path, text)
