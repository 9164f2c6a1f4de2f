"""ABB's Externally Guided Motion: messages, a simulated controller, and a client for a simulated or a real one."""
