"""The panel of controllers as a window of its own."""
