"""Remappings, prepared: each side as a tuple of substitutions."""

from __future__ import annotations

from collections.abc import Iterable

from launch.utilities import ensure_argument_type, normalize_to_list_of_substitutions

from ..remap_rule_type import RemapRule, RemapRules, SomeRemapRule, SomeRemapRules


def normalize_remap_rule(remap_rule: SomeRemapRule) -> RemapRule:
    """Return a remapping, prepared.

    Raises
    ------
    TypeError
        If it is not a pair of texts.
    """
    ensure_argument_type(remap_rule, (tuple), "remap_rule")
    if len(remap_rule) != 2:
        raise TypeError(f"a remap rule must be a tuple of length 2, got length {len(remap_rule)}")
    source, destination = remap_rule
    return (
        tuple(normalize_to_list_of_substitutions(source)),
        tuple(normalize_to_list_of_substitutions(destination)),
    )


def normalize_remap_rules(remap_rules: SomeRemapRules) -> RemapRules:
    """Yield remappings, prepared.

    Raises
    ------
    TypeError
        If one is not a pair of texts.
    """
    ensure_argument_type(remap_rules, (Iterable), "remap_rules")
    yield from map(normalize_remap_rule, remap_rules)
