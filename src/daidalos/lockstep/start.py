"""Program of a lock-step run: ``python -m daidalos.lockstep.start OPTIONS -- COMMAND ARGUMENT...``.

It replaces threads and clocks before anything else is imported.
"""

from __future__ import annotations

import os
import subprocess
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from dataclasses import dataclass

_ENVIRONMENT = {
    "RMW_IMPLEMENTATION": "rmw_daidalos_inprocess",
    # What makes Python, numpy and linear algebra compute alike on machines of one architecture.
    "PYTHONHASHSEED": "0",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "OPENBLAS_CORETYPE": "Haswell",
    "NPY_DISABLE_CPU_FEATURES": "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR",
}


@dataclass(frozen=True)
class Options:
    """Options of a run.

    Parameters
    ----------
    seed : int
        Of all random numbers.
    until_s : float, optional
        Simulated time [s] after which the command is interrupted.
    bag : str, optional
        Folder of the bag to which all topics are recorded.
    """

    seed: int = 0
    until_s: float | None = None
    bag: str | None = None

    @classmethod
    def of(cls, args: Namespace) -> Options:
        """Return the options of a parsed command line."""
        return cls(args.seed, args.until, args.bag)

    def words(self) -> list[str]:
        """Return them as words of a command line."""
        until = [] if self.until_s is None else ["--until", repr(self.until_s)]
        bag = [] if self.bag is None else ["--bag", self.bag]
        return ["--seed", str(self.seed), *until, *bag]


def replace_process(command: Sequence[str], options: Options) -> int:
    """Run a command line in lock-step in place of this process; return its exit status where that cannot be replaced.

    Parameters
    ----------
    command : sequence of str
        Of a program of this Python, such as ``["ros2", "launch", ...]``.
    options : Options
    """
    words = [sys.executable, "-m", "daidalos.lockstep.start", *options.words(), "--", *command]
    environment = os.environ | _ENVIRONMENT
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    if os.name != "nt":  # where a replaced process ends at once for who started it
        os.execve(sys.executable, words, environment)
    return subprocess.call(words, env=environment)


def main() -> None:
    """Run the command line of this process, and end with its exit status."""
    parser = ArgumentParser("python -m daidalos.lockstep.start")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--until", type=float)
    parser.add_argument("--bag")
    parser.add_argument("command", nargs="+")
    args = parser.parse_args()

    from daidalos.lockstep.run import Run, exit_status
    from daidalos.lockstep.scheduler import LockstepError

    run = Run(args.seed)
    from daidalos.lockstep.session import start

    try:
        program = start(run, args.command, args.until, args.bag)
        run.go()
        status = exit_status(run, program)
    except LockstepError as error:
        sys.stderr.write(f"[lockstep] {error}\n")
        status = 1
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os._exit(status)  # threads that stand where they stopped would go on


if __name__ == "__main__":
    main()
