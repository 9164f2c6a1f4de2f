"""Server of recovery behaviors."""
