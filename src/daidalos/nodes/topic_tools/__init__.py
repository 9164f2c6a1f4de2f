"""Tools that relay, throttle, select and transform topics of any type."""

COMPONENTS = {
    "RelayNode": "relay:RelayNode",
    "ThrottleNode": "throttle:ThrottleNode",
    "DropNode": "drop:DropNode",
    "MuxNode": "mux:MuxNode",
    "DemuxNode": "demux:DemuxNode",
    "DelayNode": "delay:DelayNode",
}
