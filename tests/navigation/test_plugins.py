"""Plugin names of Nav2's parameter files."""

import pytest

from daidalos.navigation import plugins
from daidalos.navigation.controllers.controller import Controller
from daidalos.navigation.controllers.mppi.critics.cost_critic import CostCritic, CostCriticParameters
from daidalos.navigation.planners.navfn_planner import NavfnPlanner, NavfnPlannerParameters
from daidalos.navigation.plugins import UnknownPlugin, find_plugin


@pytest.mark.parametrize("name", ["nav2_navfn_planner::NavfnPlanner", "nav2_navfn_planner/NavfnPlanner"])
def test_both_spellings_are_found(name):
    plugin = find_plugin(name)
    assert plugin.made_by is NavfnPlanner
    assert plugin.parameters is NavfnPlannerParameters


def test_critics_need_no_namespace():
    assert find_plugin("CostCritic").made_by is CostCritic
    assert find_plugin("CostCritic").parameters is CostCriticParameters


@pytest.mark.parametrize("name", plugins._CLASSES)
def test_every_name_of_the_table_has_a_class(name):
    assert isinstance(find_plugin(name).made_by, type)


def test_controllers_keep_the_contract():
    assert issubclass(find_plugin("nav2_mppi_controller::MPPIController").made_by, Controller)


def test_an_unknown_name_names_the_nearest():
    with pytest.raises(UnknownPlugin, match=r"nav2_navfn_planner::NavfnPlaner.*did you mean.*NavfnPlanner"):
        find_plugin("nav2_navfn_planner::NavfnPlaner")
