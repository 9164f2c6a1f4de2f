"""Content filters: the language, and subscriptions that use it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rclpy.impl.content_filter import ContentFilterError, parse
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from rclpy.subscription_content_filter_options import ContentFilterOptions
from std_msgs.msg import Int32
from test_msgs.msg import BasicTypes, Nested, Strings, UnboundedSequences

from ros.rclpy.waiting import executor_of, run_ready

TEN = BasicTypes(int32_value=10, float64_value=2.5, bool_value=True)


@pytest.mark.parametrize(
    ("expression", "parameters", "holds"),
    [
        ("int32_value = 10", (), True),
        ("int32_value = %0", ("10",), True),
        ("int32_value <> 10", (), False),
        ("int32_value != 11", (), True),
        ("int32_value >= 10 AND int32_value <= 10", (), True),
        ("int32_value < 10 OR float64_value > %0", ("2.4",), True),
        ("NOT int32_value < 10", (), True),
        ("not (int32_value < 10 or bool_value = false)", (), True),
        ("int32_value BETWEEN 5 AND 10", (), True),
        ("int32_value not between 5 and 9", (), True),
        ("bool_value = TRUE", (), True),
        ("float64_value = 25e-1", (), True),
        ("10 = int32_value", (), True),
        ("int32_value = 0x0A", (), True),
        ("int32_value = 1 AND int32_value = 10 OR bool_value = TRUE", (), True),
        ("int32_value = 1 AND (int32_value = 10 OR bool_value = TRUE)", (), False),
        ("int32_value > -1", (), True),
    ],
)
def test_conditions(expression: str, parameters: tuple[str, ...], holds: bool) -> None:
    assert parse(expression, parameters)(TEN) is holds


@pytest.mark.parametrize(
    ("pattern", "holds"),
    [("'hello'", True), ("'he%'", True), ("'h_llo'", True), ("'%l%'", True), ("'HE%'", False), ("'h.*'", False)],
)
def test_patterns(pattern: str, holds: bool) -> None:
    assert parse(f"string_value LIKE {pattern}", ())(Strings(string_value="hello")) is holds
    assert parse("string_value LIKE %0", (pattern,))(Strings(string_value="hello")) is holds


def test_fields_within_fields_and_sequences() -> None:
    nested = Nested(basic_types_value=TEN)
    assert parse("basic_types_value.int32_value = 10", ())(nested)
    assert parse("int32_values[1] = 7", ())(UnboundedSequences(int32_values=[1, 7]))


@pytest.mark.parametrize(
    ("expression", "word"),
    [
        ("int32_value", "operator"),
        ("int32_value =", "value"),
        ("= 3", "value"),
        ("(int32_value = 3", "')'"),
        ("int32_value = 3 )", "end"),
        ("int32_value = %1", "parameter %1"),
        ("int32_value BETWEEN 3", "'AND'"),
        ("int32_value NOT 3", "'BETWEEN'"),
        ("int32_value = 3 & 4", "a value or an operator at character 17"),
        ("", "value"),
    ],
)
def test_faults_are_named(expression: str, word: str) -> None:
    with pytest.raises(ContentFilterError, match=word.replace("(", r"\(").replace(")", r"\)")):
        parse(expression, ("3",))


@given(st.text(alphabet="int32_value =<>()%0123'ANDORNOTLIKEBETWEEN. ", max_size=40))
def test_any_text_is_a_condition_or_a_fault(text: str) -> None:
    try:
        condition = parse(text, ("1",))
    except ContentFilterError:
        return
    assert callable(condition)


def test_a_subscription_receives_what_it_wants(node: Node) -> None:
    received: list[int] = []
    executor = executor_of(node)
    subscription = node.create_subscription(
        Int32,
        "numbers",
        lambda message: received.append(message.data),
        10,
        content_filter_options=ContentFilterOptions("data > %0", ["15"]),
    )
    publisher = node.create_publisher(Int32, "numbers", 10)

    def publish() -> list[int]:
        received.clear()
        for number in (10, 20, 30):
            publisher.publish(Int32(data=number))
        run_ready(executor)
        return received

    assert subscription.is_cft_enabled
    assert publish() == [20, 30]
    assert subscription.get_content_filter() == ContentFilterOptions("data > %0", ["15"])
    subscription.set_content_filter("data < 15")
    assert publish() == [10]
    subscription.set_content_filter("", [])
    assert not subscription.is_cft_enabled
    assert publish() == [10, 20, 30]
    assert subscription.get_content_filter() == ContentFilterOptions()


def test_serialised_messages_are_filtered_too(node: Node) -> None:
    received: list[bytes] = []
    subscription = node.create_subscription(Int32, "numbers", received.append, 10, raw=True)
    subscription.set_content_filter("data = 2")
    publisher = node.create_publisher(Int32, "numbers", 10)
    for number in (1, 2, 3):
        publisher.publish(Int32(data=number))
    run_ready(executor_of(node))
    assert [deserialize_message(data, Int32).data for data in received] == [2]


@pytest.mark.parametrize("expression", ["no_field = 3", "data LIKE", "data < 'text'"])
def test_a_condition_that_does_not_fit_is_refused_at_once(node: Node, expression: str) -> None:
    subscription = node.create_subscription(Int32, "numbers", print, 10)
    with pytest.raises(ContentFilterError):
        subscription.set_content_filter(expression)
    assert not subscription.is_cft_enabled
    with pytest.raises(ContentFilterError):
        node.create_subscription(Int32, "numbers", print, 10, content_filter_options=ContentFilterOptions(expression))
    assert node.count_subscribers("numbers") == 1
