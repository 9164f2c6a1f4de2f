"""Publishers that send controllers their goals."""
