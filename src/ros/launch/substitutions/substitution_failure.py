"""The error of a substitution whose text can not be worked out."""


class SubstitutionFailure(RuntimeError):
    """A substitution's text can not be worked out."""

    def __init__(self, msg: object) -> None:
        super().__init__(msg)
