"""ROS 2's environment variables: what they may hold, and what is said when they hold something else."""

from __future__ import annotations

import pytest

from daidalos.transport.environment import DiscoveryRange, Environment, EnvironmentVariableError, read_environment
from daidalos.transport.shared import make_backend


def test_defaults_stay_on_this_machine():
    assert read_environment({}) == Environment(0, DiscoveryRange.LOCALHOST, (), "rmw_zenoh_cpp")


def test_everything_said():
    variables = {
        "ROS_DOMAIN_ID": "42",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "subnet",
        "ROS_STATIC_PEERS": "10.0.0.1; robot.local;;",
        "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp",
    }
    expected = Environment(42, DiscoveryRange.SUBNET, ("10.0.0.1", "robot.local"), "rmw_cyclonedds_cpp")
    assert read_environment(variables) == expected
    assert read_environment(variables, domain=7).domain == 7


def test_humbles_variable_keeps_to_this_machine():
    variables = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_STATIC_PEERS": "10.0.0.1"}
    assert read_environment({**variables, "ROS_LOCALHOST_ONLY": "1"}) == Environment()
    assert read_environment({**variables, "ROS_LOCALHOST_ONLY": "0"}).discovery is DiscoveryRange.SUBNET


@pytest.mark.parametrize(
    ("variable", "value", "words"),
    [
        ("ROS_DOMAIN_ID", "x", "ROS_DOMAIN_ID is 'x', expected a number from 0 to 232"),
        ("ROS_DOMAIN_ID", "233", "ROS_DOMAIN_ID is 233"),
        ("ROS_DOMAIN_ID", "-1", "ROS_DOMAIN_ID is -1"),
        ("ROS_AUTOMATIC_DISCOVERY_RANGE", "PLANET", "expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT"),
    ],
)
def test_wrong_values_are_named(variable, value, words):
    with pytest.raises(EnvironmentVariableError, match=words):
        read_environment({variable: value})


def test_a_middleware_that_is_not_there_is_named_with_those_that_are():
    with pytest.raises(EnvironmentVariableError, match=r"'rmw_fastrtps_cpp'.*rmw_zenoh_cpp, rmw_cyclonedds_cpp"):
        make_backend(Environment(middleware="rmw_fastrtps_cpp"))
