"""Errors of localization."""

from daidalos.common.errors import UserError


class LocalizationError(UserError):
    """Localization can not be set up as asked; the message is one line for the person who asked."""
