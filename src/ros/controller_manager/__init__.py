"""What launch files import to start controllers."""
