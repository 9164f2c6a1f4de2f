"""Server that finds routes through graphs and tracks robots along them."""
