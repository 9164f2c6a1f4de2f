"""ABB Robot Web Services over a running program: resources, events and the web server of versions 1.0 and 2.0."""
