"""Options of a lock-step run, as commands take them."""

from __future__ import annotations

import math
from argparse import ArgumentParser, Namespace, _ActionsContainer
from collections.abc import Sequence
from dataclasses import dataclass

from daidalos.common.errors import UserError


@dataclass(frozen=True)
class Options:
    """Options of a run.

    Parameters
    ----------
    seed : int
        Of all random numbers.
    until_s : float, optional
        Simulated time [s] after which the run ends.
    bag : str, optional
        Folder of the bag to which all topics are recorded.
    exclude : str, optional
        Regular expression of topics that are not recorded.
    """

    seed: int = 0
    until_s: float | None = None
    bag: str | None = None
    exclude: str | None = None

    @classmethod
    def of(cls, args: Namespace) -> Options:
        """Return the options of a parsed command line."""
        return cls(args.seed or 0, args.until, args.bag, args.exclude_regex)

    def words(self) -> list[str]:
        """Return them as words of a command line."""
        until = [] if self.until_s is None else ["--until", repr(self.until_s)]
        bag = [] if self.bag is None else ["--bag", self.bag]
        exclude = [] if self.exclude is None else ["--exclude-regex", self.exclude]
        return ["--seed", str(self.seed), *until, *bag, *exclude]


def add_arguments(parser: ArgumentParser, *, seed: bool = True) -> None:
    """Declare ``--lockstep`` and the options of a run for a command that also runs without.

    Parameters
    ----------
    parser : ArgumentParser
    seed : bool
        Whether to declare ``--seed``; False for a command whose own it is.
    """
    group = parser.add_argument_group("lock-step", "all nodes in one process under a stepped clock; not in ROS 2")
    group.add_argument(
        "--lockstep",
        action="store_true",
        help="Run as fast as the machine can, the same every time: threads run one at a time, in the order of "
        "simulated time.",
    )
    add_options(group, seed=seed)


def add_options(parser: _ActionsContainer, *, seed: bool = True) -> None:
    """Declare the options of a run, which `Options.of` reads."""
    if seed:
        parser.add_argument("--seed", type=int, metavar="N", help="Seed of all random numbers (default: 0)")
    parser.add_argument("--until", type=_positive, metavar="S", help="Stop the run after S simulated seconds")
    parser.add_argument("--bag", metavar="FOLDER", help="Record all topics to a bag")
    parser.add_argument(
        "--exclude-regex",
        metavar="REGEX",
        help="Topics that are not recorded, such as those of cameras",
    )


def check(args: Namespace, *, seed: bool = True) -> None:
    """Raise UserError for an option of a run without ``--lockstep``; see `add_arguments`."""
    names = ("seed", "until", "bag", "exclude_regex")[0 if seed else 1 :]
    given = [f"--{name.replace('_', '-')}" for name in names if getattr(args, name) is not None]
    if given and not args.lockstep:
        raise UserError(f"{' and '.join(given)} only act together with --lockstep")


def without_options(words: Sequence[str]) -> list[str]:
    """Return the words of a command line without ``--lockstep`` and the options of a run."""
    parser = ArgumentParser(add_help=False)
    add_arguments(parser)
    return parser.parse_known_args(words)[1]


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < math.inf:
        raise ValueError
    return value
