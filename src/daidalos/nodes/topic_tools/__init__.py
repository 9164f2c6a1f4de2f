"""Relaying, thinning out, choosing and transforming topics of any type."""

COMPONENTS = {
    "RelayNode": "relay:Relay",
    "ThrottleNode": "throttle:Throttle",
    "DropNode": "drop:Drop",
    "MuxNode": "mux:Mux",
    "DemuxNode": "demux:Demux",
    "DelayNode": "delay:Delay",
}
