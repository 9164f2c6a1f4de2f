"""How many examples property tests try."""

from typing import Any

from hypothesis import settings

FULL = 100


def examples(count: int, **more: Any) -> settings:
    """Return settings with a number of examples for a full run; the quick suite tries a fifth of them.

    Parameters
    ----------
    count
        Number of examples of a full run.
    more
        Further settings.
    """
    return settings(max_examples=max(3, count * settings.default.max_examples // FULL), **more)
