"""Conditions."""

import pytest
from launch import Action, Condition, LaunchContext
from launch.conditions import (
    IfCondition,
    InvalidConditionExpressionError,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    UnlessCondition,
    evaluate_condition_expression,
)
from launch.substitutions import LaunchConfiguration, TextSubstitution


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("true", True),
        ("True", True),
        ("TRUE", True),
        ("1", True),
        (" true ", True),
        ("false", False),
        ("False", False),
        ("0", False),
    ],
)
def test_texts_that_mean_something(text, meaning):
    context = LaunchContext()
    assert evaluate_condition_expression(context, [TextSubstitution(text=text)]) is meaning
    assert IfCondition(text).evaluate(context) is meaning
    assert UnlessCondition(text).evaluate(context) is not meaning


@pytest.mark.parametrize("text", ["", "yes", "2", "truefalse"])
def test_texts_that_mean_nothing(text):
    for condition in (IfCondition(text), UnlessCondition(text)):
        with pytest.raises(InvalidConditionExpressionError, match="expected one of"):
            condition.evaluate(LaunchContext())


def test_conditions_are_made_of_substitutions():
    context = LaunchContext()
    context.launch_configurations["part"] = "ru"
    assert IfCondition(["t", LaunchConfiguration("part"), "e"]).evaluate(context)
    assert IfCondition(LaunchConfiguration("part", default="x")).describe() == "IfCondition(LaunchConfig('part'))"
    assert "UnlessCondition" in UnlessCondition("true").describe()


def test_predicates():
    context = LaunchContext()
    assert Condition().evaluate(context) is False
    assert Condition(predicate=lambda given: given is context).evaluate(context)
    assert "Condition" in Condition().describe()


@pytest.mark.parametrize(
    ("value", "expected", "equal"),
    [("a", "a", True), ("a", "b", False), (None, None, True), (None, "a", False), ("a", None, False)],
)
def test_configurations_compared(value, expected, equal):
    context = LaunchContext()
    if value is not None:
        context.launch_configurations["x"] = value
    for condition, holds in ((LaunchConfigurationEquals, equal), (LaunchConfigurationNotEquals, not equal)):
        with pytest.warns(UserWarning, match=f"{condition.__name__} is deprecated"):
            assert condition("x", expected).evaluate(context) is holds


def test_an_action_is_executed_only_if_its_condition_holds():
    class Counting(Action):
        executed = 0

        def execute(self, context):
            self.executed += 1
            return []

    context = LaunchContext()
    for condition, executed in ((None, 1), (IfCondition("true"), 1), (IfCondition("false"), 0)):
        action = Counting(condition=condition)
        result = action.visit(context)
        assert action.executed == executed
        assert (result is None) == (executed == 0)
        assert action.condition is condition
