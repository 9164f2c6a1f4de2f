"""The server that navigates by behaviour trees."""
