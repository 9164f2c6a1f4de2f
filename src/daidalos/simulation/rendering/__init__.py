"""Software renderer for the simulator's cameras.

`renderer` is the entrance: it takes a scene, a pinhole and a pose, and returns arrays.
"""
