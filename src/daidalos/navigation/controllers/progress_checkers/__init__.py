"""Progress checkers."""
