"""Notations of names."""


def camel_case(name: str) -> str:
    """Return a name such as ``send_goal`` in camel case: ``SendGoal``."""
    return "".join(word.capitalize() for word in name.split("_"))
