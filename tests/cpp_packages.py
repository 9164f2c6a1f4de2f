"""What tests of C++ packages share: the tools, and one library for all of them."""

from pathlib import Path

import pytest

from daidalos.common.cache_folder import cache_folder
from daidalos.workspaces.errors import WorkspaceError
from daidalos.workspaces.native.toolchain import find_toolchain


def need_compiler() -> None:
    """Skip the test, with the reason, where C++ cannot be built."""
    try:
        find_toolchain()
    except WorkspaceError as error:
        pytest.skip(str(error))


def share_library(home: Path) -> None:
    """Provide builds below a home folder with an earlier library, or build it for the tests that follow."""
    folder = cache_folder() / "cpp"
    folder.mkdir(parents=True, exist_ok=True)
    own = home / ".cache" / "daidalos"
    own.mkdir(parents=True, exist_ok=True)
    (own / "cpp").symlink_to(folder, target_is_directory=True)
