"""Publishers of controllers' goals."""
