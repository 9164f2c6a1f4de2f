"""Studio under the name of rqt."""
