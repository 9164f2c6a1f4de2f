"""Domains that tests reserve."""

import pytest
from domain_coordinator import domain_id


def test_domains_differ_while_they_are_held():
    with domain_id() as first, domain_id() as second:
        assert min(first, second) >= 1
        assert max(first, second) <= 100
        assert first != second


def test_a_domain_is_free_again_afterwards():
    with domain_id() as held:
        with pytest.raises(RuntimeError, match="none of the ROS domains"), domain_id(lambda: held):
            pass
        proposals = iter([held, held, held % 100 + 1])
        with domain_id(lambda: next(proposals, 1)) as other:
            assert other != held
    with domain_id(lambda: held) as again:
        assert again == held


def test_a_process_reserves_the_same_domain_again():
    with domain_id() as first:
        pass
    with domain_id() as second:
        assert second == first
