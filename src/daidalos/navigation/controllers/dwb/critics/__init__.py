"""Critics of the DWB controller."""
