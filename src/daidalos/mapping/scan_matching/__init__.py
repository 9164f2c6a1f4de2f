"""Scan matching: correlative search for a coarse pose, point-to-line refinement for an accurate one."""
