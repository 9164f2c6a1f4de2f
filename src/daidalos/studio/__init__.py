"""The browser studio's server and page."""
