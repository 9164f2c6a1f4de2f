"""Studio under the name of rqt_gui."""
