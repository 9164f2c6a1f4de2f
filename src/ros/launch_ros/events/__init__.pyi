from . import lifecycle as lifecycle
from . import matchers as matchers
