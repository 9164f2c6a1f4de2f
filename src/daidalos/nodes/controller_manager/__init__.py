"""ros2_control's controller manager and what speaks to it."""

EXECUTABLES = {
    "spawner": "spawner",
    "unspawner": "unspawner",
    # as Foxy and Galactic called them
    "spawner.py": "spawner",
    "unspawner.py": "unspawner",
}
