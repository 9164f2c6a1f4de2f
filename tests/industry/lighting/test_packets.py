"""Packets of Art-Net, sACN and USB widgets, byte by byte as the public specifications write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.industry.lighting import artnet, enttec, sacn
from daidalos.industry.lighting.artnet import Dmx, PacketError

levels = st.binary(min_size=1, max_size=512)
CID = bytes(range(16))


def test_an_artdmx_packet_byte_by_byte():
    expected = bytes.fromhex("4172742d4e657400 0050 000e 07 00 23 01 0004 010203 00")
    assert artnet.dmx_packet(0x0123, 7, b"\1\2\3") == expected


@given(st.integers(0, artnet.MAX_UNIVERSE), st.integers(0, 255), levels)
def test_artdmx_there_and_back(universe, sequence, data):
    packet = artnet.dmx_packet(universe, sequence, data)
    assert len(packet) == 18 + len(data) + len(data) % 2
    padded = data + b"\0" * (len(data) % 2)
    assert artnet.parse_dmx(packet) == Dmx(universe, sequence, padded)
    assert artnet.parse_dmx(packet + b"more") == Dmx(universe, sequence, padded)


@given(st.binary(max_size=600))
def test_other_data_is_no_artdmx(data):
    with pytest.raises(PacketError):
        artnet.parse_dmx(data)
    with pytest.raises(PacketError):
        artnet.parse_dmx(artnet.ID + data[:9])


def test_polls():
    assert artnet.poll_packet() == b"Art-Net\0" + bytes.fromhex("0020 000e 00 00")
    assert artnet.is_poll(artnet.poll_packet())
    assert not artnet.is_poll(artnet.dmx_packet(1, 1, b"\0\0"))
    assert not artnet.is_poll(artnet.poll_packet()[:13])


def test_a_poll_reply_field_by_field():
    reply = artnet.poll_reply("10.1.2.3", 0x1234, 2, "x" * 40, "long", "sending")
    assert len(reply) == 239
    assert reply[:10] == b"Art-Net\0\x00\x21"
    assert reply[10:14] == bytes([10, 1, 2, 3])
    assert reply[14:16] == (6454).to_bytes(2, "little")
    assert (reply[18], reply[19]) == (0x12, 0x3)  # net and sub-net
    assert reply[26:44] == b"x" * 17 + b"\0"
    assert reply[44:108] == b"long".ljust(64, b"\0")
    assert reply[108:172].rstrip(b"\0") == b"#0001 [0002] sending"
    assert reply[172:174] == b"\0\1"  # ports
    assert reply[174] == 0x40  # puts DMX512 on the network
    assert reply[186] == 0x4  # its universe within the sub-net
    assert reply[200] == 0x01  # a controller
    assert reply[207:212] == bytes([10, 1, 2, 3, 2])
    assert reply[212] & 0x08  # 15-bit addresses


def test_an_sacn_packet_byte_by_byte():
    packet = sacn.data_packet(0x0102, 9, bytes([255]) + bytes(511), CID, "Daidalos")
    assert len(packet) == 638
    assert packet[:16] == bytes.fromhex("0010 0000 4153432d45312e3137000000")
    assert packet[16:22] == bytes.fromhex("726e 00000004")  # flags and length, data
    assert packet[22:38] == CID
    assert packet[38:44] == bytes.fromhex("7258 00000002")
    assert packet[44:108] == b"Daidalos".ljust(64, b"\0")
    assert packet[108:115] == bytes.fromhex("64 0000 09 00 0102")  # priority, sync, sequence, options, universe
    assert packet[115:126] == bytes.fromhex("720b 02 a1 0000 0001 0201 00")
    assert packet[126:] == bytes([255]) + bytes(511)


@given(st.integers(1, 63999), st.integers(0, 255), levels, st.text(max_size=80), st.integers(0, 200), st.booleans())
def test_sacn_there_and_back(universe, sequence, data, source, priority, is_terminated):
    packet = sacn.data_packet(universe, sequence, data, CID, source, priority, is_terminated=is_terminated)
    found = sacn.parse_data(packet)
    assert (found.universe, found.sequence, found.data, found.cid) == (universe, sequence, data, CID)
    assert (found.priority, found.is_terminated, found.is_preview) == (priority, is_terminated, False)
    assert source.startswith(found.source)
    assert packet[107] == 0
    # Each layer's length reaches to the packet's end.
    for start in (16, 38, 115):
        assert int.from_bytes(packet[start : start + 2], "big") == 0x7000 | len(packet) - start


@given(st.binary(max_size=700))
def test_other_data_is_no_sacn(data):
    with pytest.raises(PacketError):
        sacn.parse_data(data)
    with pytest.raises(PacketError):
        sacn.parse_data(sacn.data_packet(1, 1, b"\1", CID, "a")[:-1] + data[:0])


def test_universes_are_announced_in_pages():
    first, second = sacn.discovery_packets(list(range(600, 0, -1)), CID, "me")
    assert first[18:22] == bytes.fromhex("00000008")
    assert first[40:44] == bytes.fromhex("00000002")
    assert first[114:120] == bytes.fromhex("00000001 00 01")  # the list, page 0 of 1
    assert first[120:124] == bytes.fromhex("0001 0002")
    assert len(first) == 120 + 2 * 512
    assert second[118:120] == bytes([1, 1])
    assert len(second) == 120 + 2 * 88
    assert sacn.multicast_address(0x0102) == "239.255.1.2"


@given(st.binary(max_size=512))
def test_a_frame_of_a_usb_widget(data):
    frame = enttec.dmx_frame(data)
    slots = max(len(data), 24)
    assert frame[:4] == bytes([0x7E, 6, (slots + 1) % 256, (slots + 1) // 256])
    assert frame[-1] == 0xE7
    assert enttec.parse_frame(frame) == (6, b"\0" + data.ljust(24, b"\0"))


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: artnet.dmx_packet(0x8000, 1, b"\0"),
        lambda: artnet.dmx_packet(1, 1, b""),
        lambda: artnet.dmx_packet(1, 1, bytes(513)),
        lambda: sacn.data_packet(0, 1, b"", CID, ""),
        lambda: sacn.data_packet(64000, 1, b"", CID, ""),
        lambda: sacn.data_packet(1, 1, b"", CID, "", 201),
        lambda: sacn.data_packet(1, 1, bytes(513), CID, ""),
        lambda: enttec.dmx_frame(bytes(513)),
        lambda: enttec.parse_frame(b"\x7e\6\5\0\0\xe7"),
        lambda: enttec.parse_frame(b""),
    ],
)
def test_what_fits_no_packet_is_refused(wrong):
    with pytest.raises(PacketError):
        wrong()
