"""From descriptions of models to MuJoCo's model specification, one subject a file."""
