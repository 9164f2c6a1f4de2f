"""Goal checkers."""
