"""Test drive of the demonstration, with goals and a report."""
