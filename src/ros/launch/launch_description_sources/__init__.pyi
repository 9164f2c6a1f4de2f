from .any_launch_description_source import AnyLaunchDescriptionSource as AnyLaunchDescriptionSource
from .any_launch_file_utilities import (
    get_launch_description_from_any_launch_file as get_launch_description_from_any_launch_file,
)
from .frontend_launch_description_source import (
    FrontendLaunchDescriptionSource as FrontendLaunchDescriptionSource,
)
from .frontend_launch_file_utilities import (
    get_launch_description_from_frontend_launch_file as get_launch_description_from_frontend_launch_file,
)
from .python_launch_description_source import PythonLaunchDescriptionSource as PythonLaunchDescriptionSource
from .python_launch_file_utilities import InvalidPythonLaunchFileError as InvalidPythonLaunchFileError
from .python_launch_file_utilities import (
    get_launch_description_from_python_launch_file as get_launch_description_from_python_launch_file,
)
from .python_launch_file_utilities import (
    load_python_launch_file_as_module as load_python_launch_file_as_module,
)
