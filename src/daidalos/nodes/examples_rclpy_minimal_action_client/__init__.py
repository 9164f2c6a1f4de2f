"""Minimal action clients."""

EXECUTABLES = {"client": "client", "client_asyncio": "client", "client_not_composable": "client"}
