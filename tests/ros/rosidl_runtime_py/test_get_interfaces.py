"""Interfaces by package."""

from argparse import Namespace

import pytest
from rosidl_runtime_py.get_interfaces import get_interfaces, get_service_interfaces

from daidalos.cli.ros2.errors import CliError
from daidalos.cli.ros2.interface.package import PackageVerb


def test_a_package_without_interfaces_is_left_out() -> None:
    found = get_interfaces(["std_srvs", "rclpy"])
    assert list(found) == ["std_srvs"]
    assert "srv/SetBool" in found["std_srvs"]
    assert get_service_interfaces(["rclpy", "std_msgs"]) == {}


def test_a_package_that_there_is_not_is_an_error() -> None:
    with pytest.raises(LookupError, match="Unknown package 'no_such_package'"):
        get_interfaces(["no_such_package"])


def test_the_command_says_that_there_are_none() -> None:
    with pytest.raises(CliError, match="'rclpy' defines no interfaces"):
        PackageVerb().main(args=Namespace(package_name="rclpy", kind=None))
