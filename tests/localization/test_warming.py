"""Compiling ahead: everything is called, and progress is told."""

from daidalos.localization import warm_up


def test_progress_goes_from_nothing_to_all():
    told = []
    warm_up(lambda share, step: told.append((share, step)))
    shares = [share for share, _ in told]
    assert shares[0] == 0.0
    assert shares == sorted(shares)
    assert told[-1] == (1.0, "ready")
