"""Links between processes of one machine: socket files, which only their user can open, beside TCP on loopback.

Both are zenoh's own, measured in turns; figures are medians.
"""

from __future__ import annotations

import statistics
from collections import defaultdict

from benchmarks.floors import TCP_LINK, UNIX_LINK, zenoh_latency, zenoh_stream

ROUNDS = 5
LINKS = {"unix": UNIX_LINK, "tcp": TCP_LINK}
SIZES = {"small": 69, "large": 1 << 20}


def run() -> dict[str, float]:
    """Measure."""
    found: dict[str, list[float]] = defaultdict(list)
    for _ in range(ROUNDS):
        for name, link in LINKS.items():
            middle, tail = zenoh_latency("zenoh_ping", link)
            found[f"links.{name}_round_trip_p50_us"].append(middle)
            found[f"links.{name}_round_trip_p99_us"].append(tail)
            for kind, size in SIZES.items():
                found[f"links.{name}_{kind}_per_s"].append(zenoh_stream(size, link))
    figures = {name: statistics.median(values) for name, values in found.items()}
    for kind in ("round_trip_p50_us", "round_trip_p99_us", "small_per_s", "large_per_s"):
        ratios = [unix / tcp for unix, tcp in zip(found[f"links.unix_{kind}"], found[f"links.tcp_{kind}"], strict=True)]
        figures[f"links.unix_over_tcp_{kind.removesuffix('_us')}"] = statistics.median(ratios)
    return figures
