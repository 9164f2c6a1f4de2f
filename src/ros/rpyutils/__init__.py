"""Imports of compiled modules: folders of their libraries, and advice where an import fails."""

from rpyutils.add_dll_directories import add_dll_directories_from_env as add_dll_directories_from_env
from rpyutils.import_c_library import import_c_library as import_c_library
