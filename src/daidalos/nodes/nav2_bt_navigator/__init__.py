"""Server of navigation by behavior trees."""
