from . import signal_management as signal_management
from . import type_utils as type_utils
from . import typing_file_path as typing_file_path
from .class_tools_impl import is_a as is_a
from .class_tools_impl import is_a_subclass as is_a_subclass
from .class_tools_impl import isclassinstance as isclassinstance
from .create_futures_impl import create_future as create_future
from .ensure_argument_type_impl import ensure_argument_type as ensure_argument_type
from .normalize_to_list_of_entities_impl import normalize_to_list_of_entities as normalize_to_list_of_entities
from .normalize_to_list_of_substitutions_impl import (
    normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
)
from .perform_substitutions_impl import perform_substitutions as perform_substitutions
from .signal_management import AsyncSafeSignalManager as AsyncSafeSignalManager
from .type_utils import AllowedTypesType as AllowedTypesType
from .type_utils import AllowedValueType as AllowedValueType
from .type_utils import ListType as ListType
from .type_utils import ListValueType as ListValueType
from .type_utils import NormalizedValueType as NormalizedValueType
from .type_utils import ScalarType as ScalarType
from .type_utils import ScalarValueType as ScalarValueType
from .type_utils import SomeValueType as SomeValueType
from .type_utils import is_instance_of as is_instance_of
from .type_utils import is_instance_of_valid_type as is_instance_of_valid_type
from .type_utils import normalize_typed_substitution as normalize_typed_substitution
from .type_utils import perform_typed_substitution as perform_typed_substitution
from .visit_all_entities_and_collect_futures_impl import (
    visit_all_entities_and_collect_futures as visit_all_entities_and_collect_futures,
)
