"""Notations of names."""

import re


def camel_case(name: str) -> str:
    """Return a name such as ``send_goal`` in camel case: ``SendGoal``."""
    return "".join(word.capitalize() for word in name.split("_"))


def snake_case(name: str) -> str:
    """Return a name such as ``SendGoal`` in snake case: ``send_goal``."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()
