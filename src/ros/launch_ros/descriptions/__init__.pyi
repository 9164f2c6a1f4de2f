from ..parameter_descriptions import Parameter as Parameter
from ..parameter_descriptions import ParameterFile as ParameterFile
from ..parameter_descriptions import ParameterValue as ParameterValue
from .composable_lifecycle_node import ComposableLifecycleNode as ComposableLifecycleNode
from .composable_node import ComposableNode as ComposableNode
