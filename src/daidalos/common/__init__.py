"""What all layers share: poses, kernels, the extension registry, errors with file and line, suggestions for names."""
