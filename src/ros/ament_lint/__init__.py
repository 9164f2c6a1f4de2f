"""Common base of the linters that packages call in their tests."""
