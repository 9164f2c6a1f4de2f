"""Conversion of .msg, .srv and .action files to Python classes, CDR codecs and type hashes."""
