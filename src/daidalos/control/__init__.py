"""Hardware interfaces, controllers and the manager that runs them."""
