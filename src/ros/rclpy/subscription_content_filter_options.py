"""Content filters of subscriptions."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass
class ContentFilterOptions:
    """A condition on messages.

    Attributes
    ----------
    filter_expression
        Such as ``int32_value > %0 AND NOT name LIKE 'test%'``: DDS 1.4, annex B, without joins. Empty for none.
    expression_parameters
        What ``%0``, ``%1`` ... stand for.
    """

    filter_expression: str = ""
    expression_parameters: list[str] = field(default_factory=list)
