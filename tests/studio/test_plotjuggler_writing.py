"""Layouts of PlotJuggler that the page saves: read again they are what was shown, and nothing unknown is lost."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.description.markup import parse_markup
from daidalos.studio.arrangement import ArrangementError, Curve, Plot, Split
from daidalos.studio.plotjuggler_layout import parse_plotjuggler
from daidalos.studio.plotjuggler_writing import PlotsState, write_plotjuggler

from .test_plotjuggler_layout import LAYOUT

BEHIND = """<Tab tab_name="arm" containers="1"><Container><DockSplitter orientation="|" count="2" sizes="0.3;0.7">
 <DockArea name="..."><plot mode="TimeSeries"><limitY min="-1"/><curve name="/a/x" color="#1f77b4"/></plot></DockArea>
 <DockArea name="..."><plot mode="TimeSeries" background_data="b"><curve name="/b/x" color="#1f77b4"/></plot></DockArea>
</DockSplitter></Container></Tab>"""
TWO_TABS = LAYOUT.replace("  <currentTabIndex", BEHIND + "<currentTabIndex")


def read(text):
    return parse_plotjuggler(text.encode(), "plots.xml")


def shown(source):
    """What the page shows of a layout: plots of tabs behind the first one lie behind each other."""
    arrangement = read(source)
    (first, *others) = arrangement.tabs
    behind = [(title, plot) for title, content in others for plot in plots_in(content)]
    return PlotsState((first, *behind), 0.0, source)


def plots_in(content):
    return [content] if isinstance(content, Plot) else [plot for part in content.parts for plot in plots_in(part)]


def without_origins(content):
    if isinstance(content, Plot):
        return replace(content, origin="")
    return replace(content, parts=tuple(map(without_origins, content.parts)))


def tree(text):
    def of(element):
        return element.tag, element.attributes, element.text.strip(), [of(child) for child in element]

    return of(parse_markup(text))


@pytest.mark.parametrize("source", [LAYOUT, TWO_TABS])
def test_what_was_not_changed_stays_as_it_was_written(source):
    assert tree(write_plotjuggler(shown(source))) == tree(source)


def test_curves_are_written_where_the_file_has_them():
    state = shown(TWO_TABS)
    (title, split), a, b = state.tabs
    over_time, inner = split.parts
    speed, joint = over_time.curves
    changed = replace(over_time, curves=(replace(joint, color="#000000"), Curve("/p/points/0/positions/1", "#ffffff")))
    split = replace(split, parts=(changed, inner))
    text = write_plotjuggler(replace(state, tabs=((title, split), a, b), span=30.0))
    assert read(text).tabs[0][1].parts[0].curves == changed.curves
    assert speed.path not in text
    assert '<transform name="Derivative" alias=""/>' in text, "a known curve keeps its transform"
    assert "/p/points[0]/positions[1]" in text
    assert read(text).span == 30.0
    assert "return value" in text, "the custom series are kept"


def test_a_plot_that_was_closed_is_gone_from_its_tab_and_another_one_is_a_new_tab():
    state = shown(TWO_TABS)
    first, _, b = state.tabs
    text = write_plotjuggler(replace(state, tabs=(first, b, ("mine", Plot((Curve("/c", "#123456"),))))))
    names = dict(read(text).tabs)
    assert list(names) == ["drive", "arm", "mine"]
    assert [curve.path for curve in names["arm"].curves] == ["/b/x"]
    assert names["mine"].curves == (Curve("/c", "#123456"),)
    assert 'background_data="b"' in text
    assert "/a/x" not in text
    assert "arm" not in dict(read(write_plotjuggler(replace(state, tabs=(first,)))).tabs)


def test_a_plot_that_was_moved_beside_others_takes_along_what_is_not_known():
    state = shown(TWO_TABS)
    (title, split), a, b = state.tabs
    text = write_plotjuggler(replace(state, tabs=((title, Split(True, (0.5, 0.5), (split.parts[0], a[1]))), b)))
    assert text.count('<limitY min="-1"/>') == 1
    assert text.count("/a/x") == 1
    assert [curve.path for plot in plots_in(read(text).tabs[0][1]) for curve in plot.curves] == [
        "/odom/twist/twist/linear/x",
        "/joint_states/position/1",
        "/a/x",
    ]


NAMES = st.sampled_from(["/odom/x", "/odom/y", "/joint_states/position/0", "/a/b/12/c/3", "/t/<&\"'>"])
COLORS = st.sampled_from(["#1f77b4", "#d62728"])
OVER_TIME = st.lists(st.builds(Curve, NAMES, COLORS), max_size=3, unique_by=lambda curve: curve.path)
OVER_FIELD = st.lists(
    st.builds(Curve, NAMES, COLORS, st.just("/odom/t")), min_size=1, max_size=3, unique_by=lambda curve: curve.path
)
PLOTS = (OVER_TIME | OVER_FIELD).map(lambda curves: Plot(tuple(curves)))


@st.composite
def splits(draw, parts):
    members = draw(st.lists(parts, min_size=2, max_size=3))
    sizes = [draw(st.integers(1, 9)) for _ in members]
    return Split(draw(st.booleans()), tuple(size / sum(sizes) for size in sizes), tuple(members))


@given(st.recursive(PLOTS, splits, max_leaves=6), st.lists(st.tuples(st.sampled_from(["a", "b"]), PLOTS), max_size=2))
def test_what_the_page_shows_is_read_again(content, behind):
    arrangement = read(write_plotjuggler(PlotsState((("main", content), *behind), 20.0)))
    ((title, first), *others) = arrangement.tabs
    assert (title, arrangement.span) == ("main", 20.0)
    assert same(without_origins(first), content)
    assert [(name, without_origins(plot)) for name, plot in others] == behind


def same(a, b):
    if isinstance(a, Plot) or isinstance(b, Plot):
        return a == b
    shares = a.across == b.across and a.shares == pytest.approx(b.shares, abs=1e-5)
    return shares and all(map(same, a.parts, b.parts))


def test_a_source_that_is_not_a_layout_is_refused():
    with pytest.raises(ArrangementError, match="not a layout of PlotJuggler"):
        write_plotjuggler(PlotsState((), 0.0, "<robot/>"))
