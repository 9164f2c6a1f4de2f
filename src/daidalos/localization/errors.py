"""What can go wrong with localization."""


class LocalizationError(Exception):
    """Localization can not be set up as asked; the message is one line for the person who asked."""
