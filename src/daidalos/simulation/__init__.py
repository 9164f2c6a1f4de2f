"""The world on MuJoCo, with its sensors and plugins."""
