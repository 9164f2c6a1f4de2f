"""Plugins of the simulator, one file each; `base` defines their contract."""
