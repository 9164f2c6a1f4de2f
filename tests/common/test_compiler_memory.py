"""Memory of the compiler, given back once kernels are compiled."""

import subprocess
import sys

import pytest

from daidalos.common.compiler_memory import unchanged_areas

SMAPS = """\
7f0000000000-7f0000100000 r-xp 00000000 08:01 12 /lib/libllvmlite.so
Rss:                 512 kB
Anonymous:             0 kB
7f0000100000-7f0000200000 r--p 00100000 08:01 12 /lib/libllvmlite.so
Rss:                 128 kB
Anonymous:            64 kB
7f0000200000-7f0000300000 rw-p 00200000 08:01 12 /lib/libllvmlite.so
Rss:                  64 kB
Anonymous:             0 kB
7f0000300000-7f0000400000 r-xp 00000000 08:01 13 /lib/libc.so
Rss:                  32 kB
Anonymous:             0 kB
7f0000400000-7f0000500000 rw-p 00000000 00:00 0
Rss:                  16 kB
Anonymous:             0 kB
"""

COMPILE = """
import numba
from daidalos.common.compiler_memory import release_compiler_memory

@numba.njit
def double(x):
    return 2 * x

double(1)
released = release_compiler_memory()
print(released, double(1.5), double(3))
"""


def test_only_unchanged_pages_of_the_compiler_are_found() -> None:
    found = list(unchanged_areas(SMAPS.splitlines(), "libllvmlite"))
    assert found == [(0x7F0000000000, 0x7F0000100000, 512 * 1024)]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="memory is given back on Linux only")
def test_kernels_are_compiled_after_the_memory_was_given_back() -> None:
    printed = subprocess.run([sys.executable, "-c", COMPILE], capture_output=True, text=True, check=True).stdout
    released, *values = printed.split()
    assert int(released) > 10_000_000
    assert values == ["3.0", "6"]
