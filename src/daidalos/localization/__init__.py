"""Finding a robot's pose in a known map."""

from collections.abc import Callable


def warm_up(progress: Callable[[float, str], None] = lambda share, step: None) -> None:
    """Compile every kernel that localization uses, so that its first scan is as fast as its second.

    Takes a while at the first call on a machine and a moment afterwards, when the machine code is on disk.

    Parameters
    ----------
    progress : callable
        Called with the share done, from 0 to 1, and what comes next.
    """
    from daidalos.localization import warming

    warming.warm_up(progress)
