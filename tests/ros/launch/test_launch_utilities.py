"""Helpers that launch's modules share."""

from pathlib import Path

import pytest
from launch import LaunchContext, LaunchDescription
from launch.actions import GroupAction, LogInfo, OpaqueFunction
from launch.event import Event
from launch.substitutions import TextSubstitution
from launch.utilities import (
    ensure_argument_type,
    is_a,
    is_a_subclass,
    isclassinstance,
    normalize_to_list_of_entities,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    visit_all_entities_and_collect_futures,
)


class Base:
    pass


class Derived(Base):
    pass


def test_class_questions():
    assert isclassinstance(Base())
    assert not isclassinstance(Base)
    assert is_a(Derived(), Base)
    assert not is_a(Base(), Derived)
    assert is_a_subclass(Derived, Base)
    assert is_a_subclass(Derived(), Base)
    assert not is_a_subclass(Base, Derived)
    assert not is_a_subclass("x", Base)


def test_argument_types():
    ensure_argument_type("a", str, "name")
    ensure_argument_type(1, (str, int), "name")
    ensure_argument_type(Derived(), [str, Base], "name", "caller")
    with pytest.raises(TypeError, match=r"'name' of Caller is expected to be str or int.*float"):
        ensure_argument_type(1.5, (str, int), "name", "Caller")
    with pytest.raises(TypeError):
        ensure_argument_type("a", ["str"], "name")


def test_entities_are_flattened():
    one, two = LogInfo(msg="1"), LaunchDescription()
    assert normalize_to_list_of_entities(one) == [one]
    assert normalize_to_list_of_entities([one, [two, (one,)]]) == [one, two, one]
    assert normalize_to_list_of_entities([]) == []
    for wrong in ("text", 1, [one, None], [one, "text"], Event()):
        with pytest.raises(TypeError):
            normalize_to_list_of_entities(wrong)


def test_texts_are_normalized():
    text = TextSubstitution(text="b")
    assert normalize_to_list_of_substitutions(text) == [text]
    assert normalize_to_list_of_substitutions([text]) == [text]
    normalized = normalize_to_list_of_substitutions(("a", text, Path("c/d")))
    assert perform_substitutions(LaunchContext(), normalized) == f"ab{Path('c/d')}"
    assert normalize_to_list_of_substitutions([]) == []
    for wrong in (1, None, [1], [None], [["a"]]):
        with pytest.raises(TypeError, match="normalize"):
            normalize_to_list_of_substitutions(wrong)


def test_the_walk_is_depth_first():
    seen = []

    def note(context, name, entities=None):
        seen.append(name)
        return entities

    def action(name, entities=None):
        return OpaqueFunction(function=note, args=[name, entities])

    tree = LaunchDescription([action("1", [action("1.1", [action("1.1.1")]), action("1.2")]), action("2")])
    assert visit_all_entities_and_collect_futures(tree, LaunchContext()) == []
    assert seen == ["1", "1.1", "1.1.1", "1.2", "2"]


def test_the_walk_collects_futures():
    class Going(OpaqueFunction):
        future = object()

        def get_asyncio_future(self):
            return self.future

    going = Going(function=lambda context: None)
    tree = GroupAction([going])
    assert visit_all_entities_and_collect_futures(tree, LaunchContext()) == [(going, going.future)]

    class Outer(Going):
        def execute(self, context):
            return [going]

    outer = Outer(function=lambda context: None)
    pairs = visit_all_entities_and_collect_futures(outer, LaunchContext())
    assert [entity for entity, _ in pairs] == [outer, going]
