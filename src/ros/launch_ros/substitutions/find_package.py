"""The substitutions that are folders of packages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from launch.frontend.expose import expose_substitution
from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution
from launch.substitutions import PathSubstitution, SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from launch import LaunchContext


class FindPackage(PathSubstitution):
    """A folder of a package; subclasses say which. The operator `/` appends to it.

    Parameters
    ----------
    package
        The package.
    """

    def __init__(self, package: SomeSubstitutionsType) -> None:
        super().__init__(self)
        self.__package = normalize_to_list_of_substitutions(package)

    @classmethod
    def parse(cls, data: Sequence[SomeSubstitutionsType]) -> tuple[type[FindPackage], dict[str, Any]]:
        """Read `$(find-pkg-... package)`."""
        if len(data) != 1:
            raise TypeError(f"a package is found by its name alone, but {len(data)} arguments were given")
        return cls, {"package": data[0]}

    @property
    def package(self) -> list[Substitution]:
        """The package."""
        return self.__package

    def find(self, package_name: str) -> str:
        """Return the folder of a package."""
        raise NotImplementedError

    def describe(self) -> str:
        """Return the substitution in words."""
        return f"{type(self).__name__}(pkg={' + '.join(sub.describe() for sub in self.package)})"

    def perform(self, context: LaunchContext) -> str:
        """Find the package."""
        from ament_index_python.packages import PackageNotFoundError

        package = perform_substitutions(context, self.package)
        try:
            return self.find(package)
        except PackageNotFoundError as error:
            raise SubstitutionFailure(str(error)) from error


@expose_substitution("find-pkg-prefix")
class FindPackagePrefix(FindPackage):
    """The prefix in which a package is installed; parameters as for `FindPackage`."""

    def find(self, package_name: str) -> str:
        """Return the prefix of a package."""
        from ament_index_python.packages import get_package_prefix

        return get_package_prefix(package_name)


@expose_substitution("find-pkg-share")
class FindPackageShare(FindPackage):
    """The folder `share/<package>` of a package; parameters as for `FindPackage`."""

    def find(self, package_name: str) -> str:
        """Return the share folder of a package."""
        from ament_index_python.packages import get_package_share_directory

        return get_package_share_directory(package_name)
