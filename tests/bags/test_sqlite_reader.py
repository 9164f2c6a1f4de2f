import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.bags.errors import BagError
from daidalos.bags.sqlite_reader import SqliteReader
from daidalos.bags.storage import FOREVER_NS
from daidalos.bags.writer import WriterOptions
from properties import examples

from .records import messages, write

CONTENT = messages(300)
ALL = ("/text", "/number")


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sqlite")
    return write(folder / "bag", CONTENT, WriterOptions("sqlite3")) / "bag_0.db3"


def read(path):
    """Return the messages of a file, or what is wrong with it."""
    try:
        reader = SqliteReader(path)
    except BagError as error:
        return str(error)
    try:
        return list(reader.messages(ALL, 0, FOREVER_NS))
    except BagError as error:
        return str(error)
    finally:
        reader.close()


def test_a_file_that_was_cut_off_is_told(file, tmp_path):
    whole = file.read_bytes()
    for cut in random.Random(4).sample(range(1, len(whole)), 40):
        path = tmp_path / "cut.db3"
        path.write_bytes(whole[:cut])
        found = read(path)
        assert isinstance(found, str)
        assert str(path) in found


@examples(150)
@given(st.data())
def test_damage_never_breaks_the_reader(file, tmp_path_factory, data):
    whole = bytearray(file.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("damaged") / "file.db3"
    path.write_bytes(whole)
    found = read(path)
    if isinstance(found, str):
        assert str(path) in found
        assert "\n" not in found
    else:
        assert len(found) <= len(CONTENT)
