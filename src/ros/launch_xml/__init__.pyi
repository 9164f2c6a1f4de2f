from . import launch_description_sources as launch_description_sources
from .entity import Entity as Entity
from .parser import Parser as Parser
