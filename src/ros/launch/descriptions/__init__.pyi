from .executable import Executable as Executable
