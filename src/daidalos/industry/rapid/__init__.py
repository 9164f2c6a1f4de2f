"""RAPID, the language of ABB's robot controllers: reading, checking, formatting and running programs."""
