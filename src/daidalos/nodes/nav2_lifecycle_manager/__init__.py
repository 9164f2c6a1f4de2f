"""Manager of the lifecycle of several nodes."""
