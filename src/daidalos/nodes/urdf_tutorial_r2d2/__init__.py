"""Small wheeled robot that drives in circles."""
