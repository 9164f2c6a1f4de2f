"""Arguments of a call, put to the parameters of the routine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from daidalos.common.suggestions import hint
from daidalos.industry.rapid.tree import Argument, Parameter, ParameterGroup, Placeholder


@dataclass
class Binding:
    """What a call hands to a routine.

    Attributes
    ----------
    given
        Pairs of parameter and argument, in the order of the parameters.
    missing
        Required parameters without an argument.
    errors
        Pairs of an argument and what is wrong with it.
    """

    given: list[tuple[Parameter, Argument]] = field(default_factory=list)
    missing: list[Parameter] = field(default_factory=list)
    errors: list[tuple[Argument, str]] = field(default_factory=list)


def bind(
    groups: Sequence[ParameterGroup], arguments: Sequence[Argument | Placeholder], left_out: Sequence[Parameter] = ()
) -> Binding:
    """Put arguments to parameters.

    Required arguments stand in the order of their parameters, by their place or by their name. Optional ones have names
    and stand where the parameters do: after the required one that is before them, and before the next.

    Parameters
    ----------
    groups
        The routine's parameters.
    arguments
        The call's arguments.
    left_out
        Required parameters that the call has no argument for, and can do without.
    """
    binding = Binding()
    required = [(index, group.alternatives[0]) for index, group in enumerate(groups) if not group.is_optional]
    required = [(index, one) for index, one in required if one not in left_out]
    optional = {
        one.name.key: (index, one)
        for index, group in enumerate(groups)
        if group.is_optional
        for one in group.alternatives
        if isinstance(one, Parameter)
    }
    found: dict[tuple[int, str], tuple[Parameter, Argument]] = {}
    position, next_required = -1, 0
    for argument in arguments:
        if isinstance(argument, Placeholder):
            next_required += 1
            continue
        if argument.is_optional:
            position = _bind_optional(binding, found, optional, argument, position)
            continue
        if next_required >= len(required):
            count = len(required)
            binding.errors.append((argument, f"one argument too many; {count or 'none'} {_are(count)} expected"))
            continue
        position, parameter = required[next_required]
        next_required += 1
        if not isinstance(parameter, Parameter):
            continue
        if argument.name is not None and argument.name.key != parameter.name.key:
            binding.errors.append(
                (argument, f"'{argument.name.text}' stands where '{parameter.name.text}' is expected")
            )
        found[position, ""] = (parameter, argument)
    binding.given = [found[index] for index in sorted(found)]
    binding.missing = [one for _, one in required[next_required:] if isinstance(one, Parameter)]
    return binding


def _bind_optional(
    binding: Binding,
    found: dict[tuple[int, str], tuple[Parameter, Argument]],
    optional: dict[str, tuple[int, Parameter]],
    argument: Argument,
    position: int,
) -> int:
    """Put an optional argument to its parameter, and return the place of the latest argument."""
    assert argument.name is not None
    text = argument.name.text
    known = optional.get(argument.name.key)
    if known is None:
        names = [one.name.text for _, one in optional.values()]
        binding.errors.append((argument, f"there is no optional argument '{text}'{_hint(text, names)}"))
        return position
    index, parameter = known
    for other, given in [pair for place, pair in found.items() if place[0] == index]:
        if other is parameter:
            binding.errors.append((argument, f"'{text}' is given twice"))
            return position
        if not (argument.is_conditional or given.is_conditional):  # of these, at most one is present
            binding.errors.append((argument, f"'{text}' and '{other.name.text}' exclude each other"))
            return position
    if parameter.type.key == "switch" and argument.value is not None and not argument.is_conditional:
        binding.errors.append((argument, f"'{text}' is a switch and has no value"))
    elif parameter.type.key != "switch" and argument.value is None:
        binding.errors.append((argument, f"'{text}' needs a value: \\{text}:=..."))
    elif index < position:
        binding.errors.append((argument, f"'{text}' stands too late; it belongs before what is already there"))
    found[index, argument.name.key] = (parameter, argument)
    return max(position, index)


def _hint(text: str, names: list[str]) -> str:
    exact = {name.lower(): name for name in names}
    return hint(text.lower(), exact) if names else "; it has none"


def _are(count: int) -> str:
    return "is" if count == 1 else "are"
