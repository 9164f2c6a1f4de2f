"""Callbacks of filters, and filters that pick messages."""

import pytest
from message_filters import Chain, ComparisonFilter, DeltaFilter, PathDeltaFilter, SimpleFilter
from message_filters.delta_filter import CachedComparisonHandler

from ros.message_filters.messages import Output, real

# Callbacks


def test_callbacks_get_their_arguments() -> None:
    source = SimpleFilter()
    plain, more = Output(source), Output(source, "a", 2)
    source.signalMessage("one")
    source.signalMessage("two", "three")
    assert plain.calls == [("one",), ("two", "three")]
    assert more.calls == [("one", "a", 2), ("two", "three", "a", 2)]


def test_connections_can_be_ended() -> None:
    source = SimpleFilter()
    calls: list[str] = []
    connections = [source.registerCallback(calls.append) for _ in range(3)]
    assert len(set(connections)) == 3
    source.unregisterCallback(connections[0])
    source.unregisterCallback(99)
    again = source.registerCallback(calls.append)
    assert again not in connections
    source.signalMessage("m")
    assert calls == ["m"] * 3


def test_a_callback_may_register_another() -> None:
    source = SimpleFilter()
    source.registerCallback(lambda message: Output(source))
    source.signalMessage("m")
    assert len(source.callbacks) == 2


# Chains


class Doubling(SimpleFilter):
    def add(self, message: int) -> None:
        self.signalMessage(2 * message)


class Odd(SimpleFilter):
    def add(self, message: int) -> None:
        if message % 2:
            self.signalMessage(message)


def test_an_empty_chain_passes_everything_on() -> None:
    source = SimpleFilter()
    output = Output(Chain(source))
    source.signalMessage(1)
    assert output.calls == [(1,)]


def test_a_chain_of_filters() -> None:
    chain, source = Chain(), SimpleFilter()
    output = Output(chain)
    odd, doubling, again = Odd(), Doubling(), Doubling()
    chain.addFilter(odd)
    chain.add(3)
    chain.addFilter(doubling)
    chain.addFilter(again)
    chain.connectInput(source)
    for number in (1, 2, 3):
        source.signalMessage(number)
    assert output.calls == [(3,), (4,), (12,)]
    assert [chain.getFilter(index) for index in range(3)] == [odd, doubling, again]
    with pytest.raises(KeyError):
        chain.getFilter(3)
    with pytest.raises(RuntimeError, match="Already connected"):
        chain.connectInput(source)


def test_a_chain_made_with_an_input_has_one() -> None:
    with pytest.raises(RuntimeError, match="Already connected"):
        Chain(SimpleFilter()).connectInput(SimpleFilter())


# Changes


def test_only_changes_pass() -> None:
    source = SimpleFilter()
    changes = DeltaFilter([lambda message: message.point.x], source)
    output = Output(changes)
    messages = [real(time, x) for time, x in enumerate((1.0, 1.0, 2.0, 2.0, 1.0))]
    for message in messages:
        source.signalMessage(message)
    assert output.calls == [(messages[0],), (messages[2],), (messages[4],)]
    with pytest.raises(RuntimeError, match="already has an incoming connection"):
        changes.connectInput(source)


def test_one_changed_field_suffices() -> None:
    changes = PathDeltaFilter(["point.x", "header.frame_id"])
    output = Output(changes)
    first, second, third = real(1, 1.0), real(2, 1.0), real(3, 1.0)
    second.header.frame_id = third.header.frame_id = "moved"
    for message in (first, second, third):
        changes.add(message)
    assert output.calls == [(first,), (second,)]


def test_fields_that_are_not_there_or_not_simple() -> None:
    missing = PathDeltaFilter(["point.colour"])
    missing.add(real(1))
    with pytest.raises(RuntimeError, match=r"'colour' of Point \(full path: 'point.colour'\)"):
        missing.add(real(2))
    whole = PathDeltaFilter(["point"])
    whole.add(real(1))
    with pytest.raises(TypeError, match="Unable to compare fields of types"):
        whole.add(real(2))


def test_other_comparisons() -> None:
    class Rising(CachedComparisonHandler):
        def do_fields_fit(self, field_a: float, field_b: float) -> bool:
            return field_b > field_a

    rising = ComparisonFilter(Rising([lambda value: value]))
    output = Output(rising)
    for value in (1, 3, 2, 3, 4):
        rising.add(value)
    assert output.calls == [(1,), (3,), (4,)]
    silent = ComparisonFilter(CachedComparisonHandler([lambda value: value]))
    silent.add(1)
    with pytest.raises(NotImplementedError, match="do_fields_fit"):
        silent.add(2)
