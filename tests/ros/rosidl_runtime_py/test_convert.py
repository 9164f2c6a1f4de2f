"""Messages as text."""

from enum import IntEnum, StrEnum

import numpy as np
import pytest
from rosidl_runtime_py.convert import message_to_csv, message_to_yaml
from std_msgs.msg import Float64, Int32, String


class Number(IntEnum):
    ONE = 1


class Name(StrEnum):
    ONE = "one"


@pytest.mark.parametrize(
    ("message", "text"),
    [(Float64(data=np.float64(2.5)), "2.5"), (Int32(data=Number.ONE), "1"), (String(data=Name.ONE), "one")],
)
def test_values_of_other_classes_are_shown_as_what_they_stand_for(message: object, text: str) -> None:
    assert message_to_yaml(message) == f"data: {text}\n"
    assert message_to_csv(message) == text


def test_a_summary_names_the_bound_of_a_sequence() -> None:
    from rosidl_runtime_py import message_to_ordereddict
    from test_msgs.msg import BoundedSequences

    fields = message_to_ordereddict(BoundedSequences(int32_values=[1, 2]), no_arr=True)
    assert fields["int32_values"] == "<sequence type: int32[3], length: 2>"


def test_a_summary_names_the_service_or_action_of_an_item() -> None:
    from rosidl_runtime_py import message_to_ordereddict
    from test_msgs.srv import BasicTypes_Event

    fields = message_to_ordereddict(BasicTypes_Event(), no_arr=True)
    assert fields["request"] == "<sequence type: test_msgs/srv/BasicTypes_Request[1], length: 0>"
