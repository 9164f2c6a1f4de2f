"""What editors ask about programs: definitions, uses, completions, outlines and renaming; and the language server."""
