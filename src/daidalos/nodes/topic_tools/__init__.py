"""Relaying, thinning out, choosing and transforming topics of any type."""

COMPONENTS = {
    "RelayNode": "relay:RelayNode",
    "ThrottleNode": "throttle:ThrottleNode",
    "DropNode": "drop:DropNode",
    "MuxNode": "mux:MuxNode",
    "DemuxNode": "demux:DemuxNode",
    "DelayNode": "delay:DelayNode",
}
