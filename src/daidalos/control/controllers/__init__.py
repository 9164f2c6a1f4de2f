"""Controllers, one per file, with the type names of parameter files."""
