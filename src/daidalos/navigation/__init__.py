"""Costmaps, planners, controllers, smoothers and behaviours of a mobile robot."""

from collections.abc import Callable


def warm_up(progress: Callable[[float, str], None] = lambda share, step: None) -> None:
    """Compile every kernel that driving to a goal uses, so that the first goal starts as fast as the second.

    Takes a while at the first call on a machine and a moment afterwards, when the machine code is on disk.

    Parameters
    ----------
    progress : callable
        Called with the share done, from 0 to 1, and what comes next.
    """
    from daidalos.navigation import warming

    warming.warm_up(progress)
