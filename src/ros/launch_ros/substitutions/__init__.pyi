from .executable_in_package import ExecutableInPackage as ExecutableInPackage
from .find_package import FindPackage as FindPackage
from .find_package import FindPackagePrefix as FindPackagePrefix
from .find_package import FindPackageShare as FindPackageShare
from .parameter import Parameter as Parameter
