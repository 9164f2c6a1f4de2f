"""Navigation's classes by the names of Nav2's parameter files."""

import pytest

from daidalos.common.extensions import UnknownExtension, find
from daidalos.navigation import extensions
from daidalos.navigation.controllers.mppi.critics.cost_critic import CostCritic, CostCriticParameters
from daidalos.navigation.controllers.mppi_controller import CriticSwitch, MppiController, MppiParameters
from daidalos.navigation.controllers.regulated_pure_pursuit_controller import RegulatedPurePursuitController
from daidalos.navigation.controllers.rotation_shim_controller import RotationShimController
from daidalos.navigation.costmap.layers.spatio_temporal_voxel_layer import SpatioTemporalVoxelLayer
from daidalos.navigation.planners.navfn_planner import NavfnPlanner
from daidalos.navigation.planners.smac_planner_2d import SmacPlanner2D
from daidalos.navigation.planners.smac_planner_hybrid import SmacPlannerHybrid
from daidalos.navigation.planners.smac_planner_lattice import SmacPlannerLattice
from daidalos.navigation.planners.theta_star_planner import ThetaStarPlanner
from daidalos.navigation.smoothers.constrained_smoother import ConstrainedSmoother


@pytest.mark.parametrize("separator", ["::", "/"])
@pytest.mark.parametrize(
    ("package", "planner"),
    [
        ("nav2_navfn_planner", NavfnPlanner),
        ("nav2_smac_planner", SmacPlanner2D),
        ("nav2_smac_planner", SmacPlannerHybrid),
        ("nav2_smac_planner", SmacPlannerLattice),
        ("nav2_theta_star_planner", ThetaStarPlanner),
    ],
)
def test_both_spellings_are_found(package, planner, separator):
    assert find(extensions.PLANNERS, f"{package}{separator}{planner.__name__}") is planner


@pytest.mark.parametrize("separator", ["::", "/"])
def test_smoothers_are_found(separator):
    assert find(extensions.SMOOTHERS, f"nav2_constrained_smoother{separator}ConstrainedSmoother") is ConstrainedSmoother


@pytest.mark.parametrize("separator", ["::", "/"])
def test_layers_of_other_packages_are_found(separator):
    name = f"spatio_temporal_voxel_layer{separator}SpatioTemporalVoxelLayer"
    assert find(extensions.COSTMAP_LAYERS, name) is SpatioTemporalVoxelLayer


def test_critics_need_no_namespace():
    assert find(extensions.CRITICS, "CostCritic") is CostCritic


@pytest.mark.parametrize(
    ("kind", "name", "message"),
    [
        (extensions.PLANNERS, "nav2_navfn_planner::NavfnPlaner", "did you mean 'nav2_navfn_planner::NavfnPlanner'"),
        (extensions.COSTMAP_LAYERS, "nav2_costmap_2d::BoxLayer", "no costmap layer 'nav2_costmap_2d::BoxLayer'; "),
        (extensions.CONTROLLERS, "rtabmap_nav::Pilot", "no navigation controller 'rtabmap_nav::Pilot'; "),
        (extensions.CRITICS, "CostCritik", "did you mean 'mppi::critics::CostCritic'"),
        (extensions.GOAL_CHECKERS, "nav2_controller::SimpleGoalCheker", "did you mean 'nav2_controller::SimpleGoalCh"),
        (
            extensions.PROGRESS_CHECKERS,
            "SimpleGoalChecker",
            "there is no progress checker 'SimpleGoalChecker'; there are: ",
        ),
        (extensions.SMOOTHERS, "nav2_smoother::Simple", "nav2_smoother::SimpleSmoother"),
        (
            extensions.BEHAVIORS,
            "nav2_behaviors::AssistTeleop",
            "did you mean 'nav2_behaviors::AssistedTeleop'",
        ),
        (extensions.TREE_NODES, "Spim", "did you mean 'Spin'"),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_unknown_names_are_told_with_the_nearest(kind, name, message):
    with pytest.raises(UnknownExtension) as caught:
        find(kind, name)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_controller_makes_the_extensions_that_its_parameters_name():
    shim = RotationShimController()
    assert isinstance(shim.primary, RegulatedPurePursuitController)
    critics = MppiController(MppiParameters(batch_size=2, critics=("GoalCritic", "mppi::critics::CostCritic"))).critics
    assert [type(critic).__name__ for critic in critics] == ["GoalCritic", "CostCritic"]
    assert isinstance(critics[1].parameters, CostCriticParameters)


def test_critics_that_are_not_enabled_are_left_out():
    switches = {"GoalCritic": CriticSwitch(enabled=False)}
    parameters = MppiParameters(batch_size=2, critics=("GoalCritic", "CostCritic"), switches=switches)
    critics = MppiController(parameters).critics
    assert [type(critic).__name__ for critic in critics] == ["CostCritic"]
