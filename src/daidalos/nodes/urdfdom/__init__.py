"""Commands that check and draw robot descriptions."""
