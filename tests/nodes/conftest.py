import itertools
import os

import pytest

_numbers = itertools.count(os.getpid())


@pytest.fixture
def domain() -> int:
    """A domain in which most likely nobody else is."""
    return 100 + next(_numbers) % 100
