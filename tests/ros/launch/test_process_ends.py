"""Ends of processes, and what begins with them: other actions, the shutdown, and their next run."""

import re

import pytest
from launch import LaunchContext
from launch.actions import (
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetLaunchConfiguration,
    Shutdown,
)
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.substitutions import LaunchConfiguration, LocalSubstitution, TextSubstitution

from ros.launched_processes import PATIENT, when_ready


def test_on_exit(run_launch, python, capsys):
    seen = []

    def on_exit(event, context):
        seen.append((event.returncode, isinstance(context, LaunchContext)))
        return LogInfo(msg="callback's entity")

    run_launch(
        python("raise SystemExit(2)", on_exit=on_exit),
        python("", on_exit=LogInfo(msg=["single ", LocalSubstitution("event.returncode")])),
        python("", on_exit=[LogInfo(msg="first"), LogInfo(msg="second")]),
    )
    assert seen == [(2, True)]
    printed = capsys.readouterr().out
    for text in ("callback's entity", "single 0", "first", "second"):
        assert text in printed


def test_required_process(run_launch, python, capsys):
    patient = python(PATIENT, sigterm_timeout="60")
    run_launch(
        patient,
        when_ready(patient, python("", on_exit=Shutdown(), name="required")),
    )
    assert patient.return_code == 0
    assert re.search(r"process\[required-\d+\] was required: shutting down", capsys.readouterr().out)


def test_exit_starts_the_next(run_launch, python):
    order = []
    first, second = python("", name="first"), python("", name="second")

    def note(context, text):
        order.append(text)

    run_launch(
        RegisterEventHandler(
            OnProcessStart(target_action=first, on_start=[OpaqueFunction(function=note, args=["started"])])
        ),
        RegisterEventHandler(
            OnProcessExit(target_action=first, on_exit=[OpaqueFunction(function=note, args=["exited"]), second])
        ),
        RegisterEventHandler(
            OnProcessExit(target_action=second, on_exit=[OpaqueFunction(function=note, args=["second"])])
        ),
        first,
    )
    assert order == ["started", "exited", "second"]


@pytest.mark.parametrize(
    ("kwargs", "runs"),
    [
        ({}, 1),
        ({"respawn": True, "respawn_max_retries": 2}, 3),
        ({"respawn": TextSubstitution(text="true"), "respawn_max_retries": TextSubstitution(text="1")}, 2),
        ({"respawn": LaunchConfiguration("again"), "respawn_max_retries": 1, "respawn_delay": 0.01}, 2),
        ({"respawn": False, "respawn_max_retries": 5}, 1),
        ({"respawn": True, "respawn_max_retries": 0}, 1),
    ],
)
def test_respawn(run_launch, python, kwargs, runs):
    exits = []
    action = python("print('x')", on_exit=lambda event, context: exits.append(event.pid), cached_output=True, **kwargs)
    run_launch(SetLaunchConfiguration("again", "True"), action)
    assert len(exits) == len(set(exits)) == runs
    assert action.get_stdout() == "x\n" * runs


def test_stopping_ends_respawning(run_launch, python):
    exits = []

    def on_exit(event, context):
        exits.append(event.pid)
        return Shutdown() if len(exits) == 3 else None

    run_launch(python("", respawn=True, on_exit=on_exit))
    assert 3 <= len(exits) <= 4


def test_stopping_ends_the_wait_for_a_respawn(run_launch, python):
    exits = []
    action = python(
        "", respawn=True, respawn_delay=1000.0, on_exit=lambda event, context: (exits.append(1), Shutdown())[1]
    )
    run_launch(action)
    assert exits == [1]
