"""Shared basis of all layers: poses, kernels, the extension registry, errors with file and line, name suggestions."""
