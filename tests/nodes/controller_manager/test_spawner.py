"""Spawning and unspawning, as the programs do it, against a manager in the same graph."""

import argparse
from pathlib import Path

import pytest
from rclpy.context import Context

from daidalos.nodes.controller_manager._client import ManagerClient, add_manager_arguments
from daidalos.nodes.controller_manager.spawner import _arguments, _spawn
from daidalos.nodes.controller_manager.unspawner import unspawn
from daidalos.nodes.runner import UserError
from nodes.controller_manager.rig import FORWARD, Rig, parameter_file, rig
from ros.graph import graph  # noqa: F401


def spawn(one: Rig, monkeypatch: pytest.MonkeyPatch, *words: str) -> None:
    monkeypatch.setattr("sys.argv", ["spawner", *words])
    _spawn(_arguments(), one.user)


def client(one: Rig) -> ManagerClient:
    parser = argparse.ArgumentParser()
    add_manager_arguments(parser)
    return ManagerClient(one.user, parser.parse_args([]))


def test_files_say_types_and_parameters(graph: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    file = parameter_file(tmp_path, "it", type=FORWARD, joints=["elbow"], interface_name="position")
    with rig() as one:
        spawn(one, monkeypatch, "it", "-p", file, "--load-only")
        assert one.states() == {"it": "unconfigured"}
        spawn(one, monkeypatch, "it", "--inactive")
        assert one.states() == {"it": "inactive"}
        spawn(one, monkeypatch, "it")
        assert one.states() == {"it": "active"}
        unspawn(client(one), ["it"], one.user)
        assert one.states() == {}


def test_parameters_of_a_launch_file_and_ros_arguments_reach_the_controller(
    graph: Context,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    file = parameter_file(tmp_path, "it", type=FORWARD, joints=["elbow"], interface_name="position")
    given = ("-r nothing:=much", "--ros-args -r ~/commands:=/bend")
    words = [word for each in given for word in ("--controller-ros-args", each)]
    with rig() as one:
        spawn(one, monkeypatch, "it", *words, "--ros-args", "-r", "__node:=s", "--params-file", file)
        assert one.states() == {"it": "active"}
        assert one.user.count_subscribers("/bend") == 1


def test_chains_start_as_a_group(graph: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    top = parameter_file(tmp_path, "top", type=FORWARD, joints=["low/elbow"], interface_name="position")
    low = parameter_file(tmp_path, "low", type=FORWARD, joints=["elbow"], interface_name="position")
    with rig() as one:
        with pytest.raises(UserError, match="starting top failed"):
            spawn(one, monkeypatch, "top", "low", "-p", top, "-p", low)
        assert one.states()["top"] == "inactive"
        spawn(one, monkeypatch, "top", "low", "-p", top, "-p", low, "--activate-as-group")
        assert one.states() == {"top": "active", "low": "active"}
        with pytest.raises(UserError, match="stopping low failed: controller 'low' is needed by 'top'"):
            unspawn(client(one), ["low"], one.user)
        unspawn(client(one), ["low", "top"], one.user)
        assert one.states() == {}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("it",), "loading controller 'it' failed"),
        (("it", "-p", "/nowhere.yaml"), "there is no parameter file '/nowhere.yaml'"),
        (("it", "-t", FORWARD), "configuring controller 'it' failed"),
        (
            ("it", "-c", "other", "--controller-manager-timeout", "0.1"),
            "there was no controller manager '/other' within",
        ),
    ],
)
def test_what_goes_wrong_is_said(
    graph: Context,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
    message: str,
) -> None:
    with rig() as one, pytest.raises(UserError, match=message):
        spawn(one, monkeypatch, *words)


def test_a_broken_file_is_named(graph: Context, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    file = tmp_path / "broken.yaml"
    file.write_text("it: [", encoding="utf-8")
    with rig() as one, pytest.raises(UserError, match=r"broken\.yaml"):
        spawn(one, monkeypatch, "it", "-p", str(file))


def test_only_what_is_loaded_is_unloaded(graph: Context) -> None:  # noqa: F811
    with rig() as one, pytest.raises(UserError, match="not loaded: it; there are: none"):
        unspawn(client(one), ["it"], one.user)
