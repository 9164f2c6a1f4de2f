"""What all layers share: the extension registry, errors with file and line, suggestions for names."""
