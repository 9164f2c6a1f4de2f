"""Error of behavior trees."""

from daidalos.navigation.errors import NavigationError


class TreeError(NavigationError):
    """Tree that cannot be built or run; the message names file, line and element."""
