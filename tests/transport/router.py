"""A router, until it is killed."""

from __future__ import annotations

import threading

from daidalos.transport.zenoh.router import Router

if __name__ == "__main__":
    router = Router()
    print("ready", flush=True)
    threading.Event().wait()
