"""Values that hardware and controllers share."""

import numpy as np
import pytest

from daidalos.control.errors import ControlError, UnknownError
from daidalos.control.interfaces import Interfaces, LoanedInterfaces


def test_names_are_places() -> None:
    interfaces = Interfaces(["a/position", "b/position"])
    assert np.all(np.isnan(interfaces.values))
    interfaces["b/position"] = 2.0
    assert interfaces["b/position"] == 2.0
    assert "a/position" in interfaces
    assert "c/position" not in interfaces


def test_unknown_and_double_names_are_refused() -> None:
    with pytest.raises(UnknownError, match="no interface 'a/positon'; did you mean 'a/position'"):
        Interfaces(["a/position"])["a/positon"]
    with pytest.raises(ControlError, match="'a/position' is there twice"):
        Interfaces(["a/position", "a/position"])


@pytest.mark.parametrize("names", [("c", "a"), ("b", "y", "a"), ()])
def test_a_loan_is_in_the_wanted_order(names: tuple[str, ...]) -> None:
    owners = (Interfaces("abc"), Interfaces("xyz"))
    for owner in owners:
        owner.values[:] = [ord(name) for name in owner.names]
    loan = LoanedInterfaces(names, owners)
    assert loan.read() == pytest.approx([ord(name) for name in names])
    loan.write(np.arange(len(names), dtype=float))
    assert loan.read() == pytest.approx(range(len(names)))


def test_a_loan_of_nothing_that_is_there_is_refused() -> None:
    with pytest.raises(UnknownError, match="no interface 'd'"):
        LoanedInterfaces(["d"], [Interfaces("abc")])
