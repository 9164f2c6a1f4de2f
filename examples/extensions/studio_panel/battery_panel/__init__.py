"""A panel for the studio: see battery.js."""
