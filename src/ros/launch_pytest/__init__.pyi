from . import actions as actions
from . import tools as tools
from .fixture import fixture as fixture
