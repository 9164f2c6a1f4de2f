"""Parameters of nodes out of files of a package, put together step by step."""

from launch_param_builder.launch_param_builder import ParameterBuilder as ParameterBuilder
from launch_param_builder.utils import ParameterBuilderFileNotFoundError as ParameterBuilderFileNotFoundError
from launch_param_builder.utils import ParameterValueType as ParameterValueType
from launch_param_builder.utils import get_path as get_path
from launch_param_builder.utils import load_file as load_file
from launch_param_builder.utils import load_xacro as load_xacro
from launch_param_builder.utils import load_yaml as load_yaml
