"""Tools for the output of nodes."""

from .output import basic_output_filter as basic_output_filter
