"""Definitions with all their dependencies, as rosbag2 writes them."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.interfaces.idl import read_idl
from daidalos.interfaces.library import BUILT_IN, InterfaceNotFound, Library
from daidalos.interfaces.schema import bag_schema, message_schema
from tests.properties import examples

LINE = "=" * 80
FILES = {
    "msg/Plain.msg": "float32 c\n",
    "msg/Deep.msg": "Plain p\nMiddle m\n",
    "msg/Middle.msg": "toys/msg/Plain p\n",
    "msg/Drawn.idl": "module toys { module msg { struct Drawn { float x; }; }; };\n",
    "msg/Both.idl": '#include "toys/msg/Drawn.idl"\n'
    "module toys { module msg { struct Both { toys::msg::Drawn d; }; }; };\n",
    "msg/OnDrawn.msg": "Drawn d\n",
    "srv/OfPlain.srv": "Plain req\n---\nPlain resp\n",
    "srv/OfDrawn.srv": "toys/Drawn req\n---\n",
    "srv/OfNone.srv": "int8 a\n---\n",
    "action/Do.action": "Plain p\n---\n---\nint8 left\n",
}


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    share = tmp_path_factory.mktemp("share")
    for name, text in FILES.items():
        path = share / "toys" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return Library([share, BUILT_IN])


def headed(*parts):
    return "\n".join(f"{LINE}\n{heading}\n{text}" for heading, text in parts)


PLAIN = ("MSG: toys/Plain", FILES["msg/Plain.msg"])


@pytest.mark.parametrize(
    ("name", "encoding", "text"),
    [
        ("toys/Plain", "ros2msg", FILES["msg/Plain.msg"]),
        (
            "toys/msg/Deep",
            "ros2msg",
            FILES["msg/Deep.msg"] + "\n" + headed(("MSG: toys/Middle", FILES["msg/Middle.msg"]), PLAIN),
        ),
        ("toys/msg/Drawn", "ros2idl", headed(("IDL: toys/msg/Drawn", FILES["msg/Drawn.idl"]))),
        (
            "toys/Both",
            "ros2idl",
            headed(("IDL: toys/Both", FILES["msg/Both.idl"]), ("IDL: toys/msg/Drawn", FILES["msg/Drawn.idl"])),
        ),
        (
            "toys/srv/OfPlain",
            "ros2msg",
            headed(("SRV: toys/srv/OfPlain", FILES["srv/OfPlain.srv"]), PLAIN),
        ),
        (
            "toys/srv/OfDrawn",
            "ros2idl",
            headed(
                ("SRV: toys/srv/OfDrawn", FILES["srv/OfDrawn.srv"]),
                ("MSG: toys/Drawn", ""),
                ("IDL: toys/Drawn", FILES["msg/Drawn.idl"]),
            ),
        ),
        ("toys/srv/OfNone", "unknown", headed(("SRV: toys/srv/OfNone", FILES["srv/OfNone.srv"]))),
    ],
)
def test_definitions(library, name, encoding, text):
    assert bag_schema(name, library) == (text, encoding)


def test_messages_that_refer_to_idl_are_translated(library):
    text, encoding = bag_schema("toys/msg/OnDrawn", library)
    assert encoding == "ros2idl"
    first, second = text.split(f"{LINE}\n")[1:]
    assert first.startswith("IDL: toys/msg/OnDrawn\n// generated from rosidl_adapter")
    assert read_idl(first.partition("\n")[2], "OnDrawn").text == "toys/Drawn d\n"
    assert second == f"IDL: toys/msg/Drawn\n{FILES['msg/Drawn.idl']}"


def test_feedback_has_a_definition(library):
    text, encoding = bag_schema("toys/action/Do_FeedbackMessage", library)
    assert encoding == "ros2msg"
    assert text.startswith("unique_identifier_msgs/UUID goal_id\ntoys/Do_Feedback feedback\n")


@pytest.mark.parametrize("name", ["toys/msg/No", "no/msg/Plain", "toys/action/Do"])
def test_unknown_types(library, name):
    with pytest.raises(InterfaceNotFound):
        bag_schema(name, library)


MESSAGES = [f"toys/msg/M{number}" for number in range(6)]


@given(st.dictionaries(st.sampled_from(MESSAGES), st.lists(st.sampled_from(range(1, 6)), max_size=4)))
@examples(50)
def test_each_message_is_there_once(tmp_path_factory, references):
    share = tmp_path_factory.mktemp("share")
    folder = share / "toys" / "msg"
    folder.mkdir(parents=True)
    for place, name in enumerate(MESSAGES):
        steps = [place + step for step in references.get(name, []) if place + step < len(MESSAGES)]
        lines = [f"{MESSAGES[other]}[] f{number}\n" for number, other in enumerate(steps)]
        (folder / f"M{place}.msg").write_text("".join(lines))
    library = Library([share])
    needed, pending = set(), list(library.get(MESSAGES[0]).nested())
    while pending:
        needed.add(name := pending.pop())
        pending += [other for other in library.get(name).nested() if other not in needed]
    headings = re.findall(rf"^{LINE}\nMSG: toys/(\w+)$", message_schema(MESSAGES[0], library), re.MULTILINE)
    assert sorted(headings) == sorted(name.rpartition("/")[2] for name in needed)
