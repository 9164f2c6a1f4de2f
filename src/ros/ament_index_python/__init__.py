"""Find installed packages and what they register, without running anything of theirs."""

from daidalos.distribution import complete_environment as _complete_environment
from daidalos.distribution import complete_prefix_path as _complete_prefix_path

from .constants import AMENT_PREFIX_PATH_ENV_VAR as AMENT_PREFIX_PATH_ENV_VAR
from .constants import RESOURCE_INDEX_SUBFOLDER as RESOURCE_INDEX_SUBFOLDER
from .packages import PackageNotFoundError as PackageNotFoundError
from .packages import get_package_prefix as get_package_prefix
from .packages import get_package_share_directory as get_package_share_directory
from .packages import get_package_share_path as get_package_share_path
from .packages import get_packages_with_prefixes as get_packages_with_prefixes
from .resources import InvalidResourceNameError as InvalidResourceNameError
from .resources import InvalidResourceTypeNameError as InvalidResourceTypeNameError
from .resources import get_resource as get_resource
from .resources import get_resource_types as get_resource_types
from .resources import get_resources as get_resources
from .resources import has_resource as has_resource
from .search_paths import get_search_paths as get_search_paths

# A program that was started without a setup file finds what the setup file of a ROS 2 installation sets.
_complete_environment()
_complete_prefix_path()
