"""Sensor models: likelihoods of scans."""
