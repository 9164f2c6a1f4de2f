"""Robot applications under test: scenarios in lock-step, what they assert, and what disturbs them."""
