"""Plugins of the simulator, one file each; `daidalos.simulation.contracts` has their contract."""
