"""Program of a lock-step run: ``python -m daidalos.lockstep.start OPTIONS -- COMMAND ARGUMENT...``.

It replaces threads and clocks before anything else is imported.
"""

from __future__ import annotations

import os
import subprocess
import sys
import traceback
from argparse import ArgumentParser
from collections.abc import Sequence

from daidalos.lockstep.options import Options, add_options

ENVIRONMENT = {
    "RMW_IMPLEMENTATION": "rmw_daidalos_inprocess",
    # What makes Python, numpy and linear algebra compute alike on machines of one architecture.
    "PYTHONHASHSEED": "0",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "OPENBLAS_CORETYPE": "Haswell",
    "NPY_DISABLE_CPU_FEATURES": "AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR",
}


def replace_process(command: Sequence[str], options: Options) -> int:
    """Run a command line in lock-step in place of this process; return its exit status where that cannot be replaced.

    Parameters
    ----------
    command : sequence of str
        Of a program of this Python, such as ``["ros2", "launch", ...]``.
    options : Options
    """
    words = [sys.executable, "-P", "-m", "daidalos.lockstep.start", *options.words(), "--", *command]
    environment = os.environ | ENVIRONMENT
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    if os.name != "nt":  # where a replaced process ends at once for who started it
        os.execve(sys.executable, words, environment)
    return subprocess.call(words, env=environment)


def main() -> None:
    """Run the command line of this process, and end with its exit status."""
    parser = ArgumentParser("python -m daidalos.lockstep.start")
    add_options(parser)
    parser.add_argument("command", nargs="+")
    args = parser.parse_args()
    options = Options.of(args)

    from daidalos.common.temporary_files import delete_temporary_files
    from daidalos.lockstep.run import Run, exit_status
    from daidalos.lockstep.scheduler import LockstepError

    run = Run(options.seed)
    from daidalos.lockstep.session import start

    try:
        program = start(run, args.command, options)
        run.go()
        status = exit_status(run, program)
    except LockstepError as error:
        sys.stderr.write(f"[lockstep] {error}\n")
        status = 1
    except Exception:  # the interpreter would wait for threads that run no more
        traceback.print_exc()
        status = 1
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    delete_temporary_files()
    os._exit(status)  # threads that stand where they stopped would go on


if __name__ == "__main__":
    main()
