"""Errors of localization."""

from daidalos.common.errors import UserError


class LocalizationError(UserError):
    """Invalid configuration or map."""
