"""Faults of motion, with the numbers and titles of ABB's event log where they are known."""

from __future__ import annotations

OUT_OF_REACH = (50050, "Position outside reach")
JOINT_RANGE = (50027, "Joint out of range")
CONFIGURATION = (50080, "Position not compatible")
SINGULARITY = (50026, "Close to singularity")
CORNER_PATH = (50024, "Corner path failure")
CIRCLE = (50063, "Circle uncertain")


class MotionFault(ValueError):
    """Movement that cannot be carried out.

    Parameters
    ----------
    kind
        Number and title of the event.
    detail
        What is wrong, with values.
    """

    def __init__(self, kind: tuple[int, str], detail: str) -> None:
        self.number, self.title = kind
        self.detail = detail
        super().__init__(f"{self.number} {self.title}: {detail}")
