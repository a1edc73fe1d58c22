"""HTTP/2 by hand over one TCP connection, for clients that no library lets one be.

Frames and header blocks come from Debian's python3-hyperframe and python3-hpack; what
is sent and what is ignored is up to the test.
"""

import contextlib
import socket
import struct

import hpack
from hyperframe import frame as frames

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
DEFAULT_WINDOW = 65_535


def grpc_message(payload, compressed=False):
    """A message as gRPC frames it: a flag, the length, the bytes."""
    return struct.pack(">BI", compressed, len(payload)) + payload


class Http2Client:
    def __init__(self, server, *, preface=PREFACE, window=DEFAULT_WINDOW):
        """Connects and says hello; `window` is how much the server may send unasked."""
        self.socket = socket.create_connection((server.host, server.port), timeout=60)
        self.authority = server.address
        self._decoder = hpack.Decoder()
        self._received = b""
        self._send_window = {0: DEFAULT_WINDOW}
        self._initial_window = DEFAULT_WINDOW
        self._next_stream = 1
        settings = frames.SettingsFrame(0)
        settings.settings = {frames.SettingsFrame.INITIAL_WINDOW_SIZE: window}
        self.send_raw(preface + settings.serialize())
        if window > DEFAULT_WINDOW:
            self.send(frames.WindowUpdateFrame(0, window_increment=window - DEFAULT_WINDOW))

    def send_raw(self, data):
        self.socket.sendall(data)

    def send(self, *sent):
        self.send_raw(b"".join(frame.serialize() for frame in sent))

    def answer(self, frame):
        """Sends what a server that has gone need not hear: what it sent before can still be read."""
        with contextlib.suppress(ConnectionError):
            self.send(frame)

    def header_block(self, path, extra=()):
        headers = [(":method", "POST"), (":scheme", "http"), (":path", path), (":authority", self.authority),
                   ("content-type", "application/grpc"), ("te", "trailers"), *extra]
        return hpack.Encoder().encode(headers, huffman=False)

    def open_stream(self, path, extra=()):
        """Sends the headers of a call; its stream."""
        stream, self._next_stream = self._next_stream, self._next_stream + 2
        self.send(frames.HeadersFrame(stream, self.header_block(path, extra), flags=["END_HEADERS"]))
        self._send_window[stream] = self._initial_window
        return stream

    def send_data(self, stream, data, end=False):
        self.send(frames.DataFrame(stream, data, flags=["END_STREAM"] if end else []))

    def start_call(self, path, request, extra=(), compressed=False):
        """Headers and one short message, and no more to come; its stream."""
        stream = self.open_stream(path, extra)
        self.send_data(stream, grpc_message(request, compressed), end=True)
        return stream

    def call(self, path, request, extra=(), compressed=False):
        """A whole call, within the server's windows: its messages' bytes and its trailers."""
        stream = self.open_stream(path, extra)
        unsent = grpc_message(request, compressed)
        answer, trailers = b"", {}
        while "grpc-status" not in trailers:
            window = min(self._send_window[0], self._send_window[stream], 16_384)
            if unsent and window:
                part, unsent = unsent[:window], unsent[window:]
                self.send_data(stream, part, end=not unsent)
                self._send_window[0] -= len(part)
                self._send_window[stream] -= len(part)
                if unsent:
                    continue
            frame = self.next_frame()
            if isinstance(frame, frames.DataFrame) and frame.stream_id == stream:
                answer += frame.data
            elif isinstance(frame, frames.HeadersFrame) and frame.stream_id == stream:
                trailers = self.headers_of(frame)
            elif isinstance(frame, frames.RstStreamFrame) and frame.stream_id == stream:
                raise ConnectionAbortedError(f"stream reset, error {frame.error_code}")
            elif isinstance(frame, frames.GoAwayFrame):
                raise ConnectionAbortedError(f"connection ended, error {frame.error_code}")
        return answer, trailers

    def next_frame(self):
        """The next frame; those of the connection are seen to. ConnectionError when it is over."""
        frame, length = frames.Frame.parse_frame_header(memoryview(self._read(9)))
        frame.parse_body(memoryview(self._read(length)))
        if isinstance(frame, frames.WindowUpdateFrame):
            self._send_window[frame.stream_id] = self._send_window.get(frame.stream_id, 0) + frame.window_increment
        elif isinstance(frame, frames.SettingsFrame) and "ACK" not in frame.flags:
            self._initial_window = frame.settings.get(frames.SettingsFrame.INITIAL_WINDOW_SIZE, self._initial_window)
            self.answer(frames.SettingsFrame(0, flags=["ACK"]))
        elif isinstance(frame, frames.PingFrame) and "ACK" not in frame.flags:
            self.answer(frames.PingFrame(0, frame.opaque_data, flags=["ACK"]))
        return frame

    def headers_of(self, frame):
        """The headers or trailers of a HeadersFrame. Each has to come here, in order."""
        return dict(self._decoder.decode(frame.data))

    def _read(self, size):
        self.receive_at_least(size)
        data, self._received = self._received[:size], self._received[size:]
        return data

    def receive_at_least(self, size):
        """Waits for `size` bytes, whatever they are, and no more."""
        while len(self._received) < size:
            data = self.socket.recv(65_536)
            if not data:
                raise ConnectionResetError("the server closed the connection")
            self._received += data

    def is_cut(self):
        """Whether the server ends the connection, after whatever it still says."""
        try:
            while self.socket.recv(65_536):
                pass
        except ConnectionError:
            pass
        except TimeoutError:
            return False
        return True

    def abort(self):
        """Goes away with a reset, as a process does that is killed."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()

    def close(self):
        self.socket.close()
