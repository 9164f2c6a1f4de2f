"""Small functions that commands and verbs share."""

import argparse
import inspect

import pytest
from ros2cli.helpers import before_invocation, bind, get_ros_domain_id, pretty_print_call, unsigned_int, wait_for


def add(first, second=2):
    return first + second


def test_binding_keeps_name_and_signature():
    bound = bind(add, 5)
    assert (bound(), bound.__name__) == (7, "add")
    assert inspect.signature(bound) == inspect.signature(add)


def test_a_hook_runs_before_each_call(capsys):
    calls = []
    assert before_invocation(add, lambda: calls.append("plain"))(1) == 3
    assert before_invocation(add, pretty_print_call)(1, second=4) == 5
    assert calls == ["plain"]
    assert capsys.readouterr().out == "add(1, second=4)\n"


def test_waiting_returns_what_the_predicate_returned():
    answers = iter([False, False, "yes"])
    assert wait_for(lambda: next(answers), timeout=5.0, period=0.0) is True
    assert wait_for(list, timeout=0.0, period=0.0) == []


@pytest.mark.parametrize("text", ["-1", "one", "1.5", ""])
def test_what_is_no_unsigned_integer(text):
    assert unsigned_int("42") == 42
    with pytest.raises(argparse.ArgumentTypeError, match="non-negative"):
        unsigned_int(text)


def test_the_domain_is_that_of_the_environment(monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert get_ros_domain_id() == 7
    monkeypatch.setenv("ROS_DOMAIN_ID", "")
    assert get_ros_domain_id() == 0
