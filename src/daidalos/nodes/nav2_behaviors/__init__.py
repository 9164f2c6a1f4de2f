"""The server of recovery behaviours."""
