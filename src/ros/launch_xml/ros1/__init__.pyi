from . import packages as packages
from .translation import is_ros1 as is_ros1
from .translation import translate as translate
