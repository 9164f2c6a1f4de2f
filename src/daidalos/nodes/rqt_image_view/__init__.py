"""What cameras see, in the studio."""
