"""The substitution that is the path of a package's executable."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from launch.frontend.expose import expose_substitution
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

from .find_package import FindPackagePrefix

if TYPE_CHECKING:
    from launch import LaunchContext


@expose_substitution("exec-in-pkg")
class ExecutableInPackage(FindPackagePrefix):
    """The file `lib/<package>/<executable>` of a package.

    Parameters
    ----------
    executable
        The executable.
    package
        The package.
    """

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        super().__init__(package)
        self.__executable = normalize_to_list_of_substitutions(executable)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[ExecutableInPackage], dict[str, Any]]:
        """Read `$(exec-in-pkg executable package)`."""
        if len(data) != 2:
            raise TypeError(f"$(exec-in-pkg ...) takes 2 arguments, but it was given {len(data)}")
        return cls, {"executable": data[0], "package": data[1]}

    @property
    def executable(self) -> list[Substitution]:
        """The executable."""
        return self.__executable

    def describe(self) -> str:
        """Return the substitution in words."""
        executable = " + ".join(sub.describe() for sub in self.executable)
        package = " + ".join(sub.describe() for sub in self.package)
        return f"ExecInPkg(pkg={package}, exec={executable})"

    def perform(self, context: LaunchContext) -> str:
        """Find the executable."""
        prefix = super().perform(context)
        package = perform_substitutions(context, self.package)
        executable = perform_substitutions(context, self.executable)
        folder = os.path.join(prefix, "lib", package)
        if not os.path.isdir(folder):
            raise SubstitutionFailure(
                f"package '{package}' found at '{prefix}', but libexec directory '{folder}' does not exist"
            )
        endings = ("", ".exe", ".py") if sys.platform == "win32" else ("",)
        for ending in endings:
            path = os.path.join(folder, executable + ending)
            if os.path.isfile(path) and os.access(path, os.X_OK):
                return path
        raise SubstitutionFailure(f"executable '{executable}' not found on the libexec directory '{folder}'")
