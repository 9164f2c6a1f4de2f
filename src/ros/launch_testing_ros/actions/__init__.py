"""Actions for launch tests with nodes."""

from .enable_rmw_isolation import EnableRmwIsolation as EnableRmwIsolation
