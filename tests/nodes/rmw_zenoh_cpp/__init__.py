"""The zenoh router's executable."""
