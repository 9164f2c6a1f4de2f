"""What can be wrong with a behaviour tree."""

from daidalos.navigation.errors import NavigationError


class TreeError(NavigationError):
    """A tree can not be built or run; the message names the file, the line and the element."""
