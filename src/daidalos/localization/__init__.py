"""Localization of a robot in a known map."""
