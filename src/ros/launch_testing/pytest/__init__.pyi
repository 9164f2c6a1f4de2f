from . import hooks as hooks
from . import hookspecs as hookspecs
