"""Errors of the user's, with their place."""

import pytest

from daidalos.common.errors import Location, UserError
from daidalos.description.errors import DescriptionError
from daidalos.workspaces.errors import WorkspaceError


@pytest.mark.parametrize(
    ("location", "text"),
    [
        (None, "it is wrong"),
        (Location(), "it is wrong"),
        (Location("a.yaml"), "a.yaml: it is wrong"),
        (Location("a.yaml", 3), "a.yaml:3: it is wrong"),
        (Location("a.yaml", 3, "speed"), "a.yaml:3: 'speed': it is wrong"),
        (Location(name="speed"), "'speed': it is wrong"),
    ],
)
def test_a_message_begins_with_the_place_as_far_as_it_is_known(location, text):
    error = UserError("it is wrong", location)
    assert str(error) == text
    assert error.location is location


def test_errors_of_the_layers_are_user_errors_with_a_location():
    error = DescriptionError("it is wrong", "a.urdf", 2, "<link>")
    assert isinstance(error, UserError)
    assert str(error) == "a.urdf:2: <link>: it is wrong"
    assert error.location == Location("a.urdf", 2)
    assert isinstance(WorkspaceError("it is wrong"), UserError)


def test_a_message_is_shown_as_it_is_written_whatever_a_file_holds():
    assert str(UserError("'a\x85b\u2028c\x1b[2Jd\re': unknown\n\tsee ü")) == (
        "'a\\x85b\\u2028c\\x1b[2Jd\\re': unknown\n\tsee ü"
    )
