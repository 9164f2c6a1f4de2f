"""Packets of the ILDA Digital Network: bytes as the specification says, and what is no packet."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from daidalos.industry.lighting import idn
from daidalos.industry.lighting.artnet import PacketError


def frame(count: int, duration: float = 0.01) -> idn.Frame:
    """Return a frame of samples along the diagonal."""
    places = np.linspace(-1.0, 1.0, count)[:, None] * np.ones(2)
    return idn.Frame(places, np.full((count, 3), 200, np.uint8), duration)


def test_the_bytes_are_those_of_the_specification() -> None:
    one = idn.Frame(np.array([[-1.0, 0.0], [1.0, 0.5]]), np.array([[0, 0, 0], [255, 128, 1]], np.uint8), 0.0005)
    wanted = bytes.fromhex(
        "40 00 0007"  # IDN-Hello: channel message, no flags, sequence
        "002e c002 00000009"  # 46 bytes, channel 0 with configuration, a whole frame, time stamp
        "04 01 00 02"  # four words follow, routing, default service, discrete graphic
        "4200 4010 4210 4010 527e 5214 51cc 0000"  # x and y of 16 bits, 638, 532 and 460 nm, filled up
        "000001f4"  # 500 us
        "8001 0000 000000  7fff 4000 ff8001"
    )
    assert idn.frame_packet(one, 7, 9) == wanted
    assert idn.close_packet(8, 9) == bytes.fromhex("44 00 0008  000c c000 00000009  00 02 00 00")
    assert idn.parse_packet(idn.close_packet(8, 9)) is None
    assert idn.parse_packet(bytes.fromhex("44 00 0008")) is None


@given(
    arrays(np.float64, st.tuples(st.integers(0, 40), st.just(2)), elements=st.floats(-1.0, 1.0)),
    st.floats(0.0, 16.0), st.integers(0, 10**6), st.integers(0, 10**12), st.integers(0, 255),
)  # fmt: skip
def test_what_is_sent_comes_back(places: np.ndarray, duration: float, sequence: int, time_us: int, red: int) -> None:
    colors = np.full((len(places), 3), red, np.uint8)
    found = idn.parse_packet(idn.frame_packet(idn.Frame(places, colors, duration), sequence, time_us))
    assert found is not None
    assert np.abs(found.places - places).max(initial=0.0) <= 0.5 / 0x7FFF + 1e-12
    assert (found.colors == colors).all()
    assert found.duration == pytest.approx(duration, abs=1e-6)


@given(st.binary(max_size=80).filter(lambda one: one[:1] != b"D"))
def test_noise_is_refused(packet: bytes) -> None:
    with pytest.raises(PacketError):
        idn.parse_packet(packet)


@given(st.integers(0, 200), st.integers(0, 255))
def test_a_changed_byte_is_a_frame_or_refused(index: int, value: int) -> None:
    packet = bytearray(idn.frame_packet(frame(24), 1, 2))
    packet[index] = value
    try:
        found = idn.parse_packet(bytes(packet))
    except PacketError:
        return
    assert found is None or (np.abs(found.places) <= 1.0).all()


def test_what_fits_no_packet_is_refused() -> None:
    assert len(idn.frame_packet(frame(idn.MAX_SAMPLES), 1, 2)) <= idn.MAX_MESSAGE + 4
    for one in (frame(idn.MAX_SAMPLES + 1), frame(3, 17.0)):
        with pytest.raises(PacketError, match="at most"):
            idn.frame_packet(one, 1, 2)
    for value in (1.01, np.nan):
        with pytest.raises(PacketError, match="from -1 to 1"):
            idn.frame_packet(idn.Frame(np.array([[0.0, value]]), np.zeros((1, 3), np.uint8), 0.1), 1, 2)
    cut = bytearray(idn.frame_packet(frame(3), 1, 2)[:-1])
    cut[4:6] = (len(cut) - 4).to_bytes(2, "big")
    with pytest.raises(PacketError, match="within a sample"):
        idn.parse_packet(bytes(cut))
