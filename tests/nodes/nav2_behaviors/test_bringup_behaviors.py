"""The behaviours that bringup's parameter file asks for."""

from ament_index_python.packages import get_package_share_path

from daidalos.common.documents import read_yaml
from daidalos.nodes.nav2_behaviors.behavior_server import BehaviorServerParameters


def test_bringup_serves_all_behaviors() -> None:
    content = read_yaml(get_package_share_path("nav2_bringup") / "params" / "nav2_params.yaml")
    asked = content["behavior_server"]["ros__parameters"]["behavior_plugins"]
    assert set(asked) == set(BehaviorServerParameters().behavior_plugins)
