"""Sessions, publishers, subscriptions, services and the graph, over zenoh, DDS or inside one process."""
