"""Bridge of gz's images, with both ends in one graph here."""
