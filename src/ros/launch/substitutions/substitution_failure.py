"""The error of a substitution whose text cannot be worked out."""


class SubstitutionFailure(RuntimeError):
    """A substitution's text cannot be worked out."""

    def __init__(self, msg: object) -> None:
        super().__init__(msg)
