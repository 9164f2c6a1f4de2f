"""Server of the rosbridge protocol over WebSockets."""
