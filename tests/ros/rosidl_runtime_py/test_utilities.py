"""Classes found by the names and types of interfaces."""

import pytest
from rosidl_parser.definition import NamespacedType, UnboundedSequence
from rosidl_runtime_py.import_message import import_message_from_namespaced_type
from rosidl_runtime_py.utilities import get_action, get_message
from std_msgs.msg import Empty


def test_the_class_of_a_sequence_is_that_of_its_items():
    one = NamespacedType(["std_msgs", "msg"], "Empty")
    assert import_message_from_namespaced_type(one) is Empty
    with pytest.warns(DeprecationWarning, match="value_type"):
        assert import_message_from_namespaced_type(UnboundedSequence(one)) is Empty


@pytest.mark.parametrize(("get", "article"), [(get_action, "an action"), (get_message, "a message")])
def test_names_of_another_kind_are_refused(get, article):
    with pytest.raises(ValueError, match=f"Expected the full name of {article}, got 'std_srvs/srv/Empty'"):
        get("std_srvs/srv/Empty")
