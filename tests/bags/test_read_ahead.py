import itertools

import pytest

from daidalos.bags.errors import BagError
from daidalos.bags.read_ahead import ReadAhead

from .records import messages


def drained(ahead):
    found = []
    while (message := ahead.next()) is not None:
        found.append(message)
    return found


@pytest.mark.parametrize("count", [0, 1, 49, 50, 51, 1000])
def test_all_come_in_order(count):
    ahead = ReadAhead(iter(messages(count)), 100)
    assert drained(ahead) == messages(count)
    assert ahead.next() is None
    ahead.close()


def test_no_more_is_read_than_wanted():
    read = []

    def endless():
        for message in itertools.cycle(messages(10)):
            read.append(message)
            yield message

    ahead = ReadAhead(endless(), 200)
    for _ in range(100):
        ahead.next()
    ahead.close()
    assert len(read) <= 100 + 200 + 100


def test_what_goes_wrong_comes_after_what_went_right():
    def broken():
        yield from messages(70)
        raise BagError("bag", "damaged")

    ahead = ReadAhead(broken(), 1000)
    assert [ahead.next() for _ in range(70)] == messages(70)
    with pytest.raises(BagError, match="damaged"):
        ahead.next()
    assert ahead.next() is None
    ahead.close()
