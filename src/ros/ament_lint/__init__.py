"""What the linters that packages call in their tests have in common."""
