from . import expose as expose
from . import type_utils as type_utils
from .entity import Entity as Entity
from .expose import expose_action as expose_action
from .expose import expose_substitution as expose_substitution
from .parser import InvalidFrontendLaunchFileError as InvalidFrontendLaunchFileError
from .parser import Parser as Parser
