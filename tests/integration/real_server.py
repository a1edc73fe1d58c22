"""What the tests of the server's edge share: real servers, certificates, calls."""

import contextlib
import importlib
import pathlib
import signal
import subprocess
import sys

import grpc


class RealServer:
    """A terrane-server on a free port of 127.0.0.1, and its log."""

    def __init__(self, program, folder, *flags, listen="127.0.0.1:0", **options):
        self.log_file = pathlib.Path(folder) / f"log-{id(self)}.txt"
        with open(self.log_file, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(
                [program, "--listen", listen, "--log-format", "json", *map(str, flags)],
                stdout=subprocess.PIPE, stderr=log, text=True, **options)
        line = self.process.stdout.readline()
        assert line.startswith("listening on "), self.log()
        self.port = int(line.rsplit(":", 1)[1])
        self.draining = False
        self.address = f"127.0.0.1:{self.port}"

    def log(self):
        return self.log_file.read_text(encoding="utf-8")

    def drain(self):
        """Sends SIGTERM, once: a second one would end the drain."""
        if not self.draining and self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        self.draining = True

    def stop(self):
        """The exit code after a drain."""
        self.drain()
        code = self.process.wait(30)
        self.process.stdout.close()
        return code


@contextlib.contextmanager
def served(program, folder, *flags, **options):
    """A server for the length of a block; it must end well."""
    server = RealServer(program, folder, *flags, **options)
    try:
        yield server
    finally:
        code = server.stop()
    assert code == 0, server.log()


class Authority:
    """A certificate authority in a folder, made with the openssl command."""

    def __init__(self, folder, name):
        self.folder, self.name = pathlib.Path(folder), name
        self.certificate = self.folder / f"{name}.pem"
        self.key = self.folder / f"{name}.key"
        openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2",
                "-subj", f"/CN={name}", "-keyout", self.key, "-out", self.certificate)

    def issue(self, name):
        """The files of a new certificate for localhost, and of its key."""
        certificate, key, request = (self.folder / f"{self.name}-{name}{end}" for end in (".pem", ".key", ".csr"))
        openssl("req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-subj", f"/CN={name}",
                "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out", request)
        openssl("x509", "-req", "-in", request, "-CA", self.certificate, "-CAkey", self.key, "-days", "2",
                "-copy_extensions", "copy", "-out", certificate)
        return certificate, key


def openssl(*arguments):
    done = subprocess.run(["openssl", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def all_methods(stubs):
    """Every rpc of terrane.v1 as its path, from the descriptors."""
    sys.path.insert(0, str(stubs))
    methods = []
    for file in sorted(pathlib.Path(stubs).glob("terrane/v1/*_pb2.py")):
        module = importlib.import_module(f"terrane.v1.{file.stem}")
        for service in module.DESCRIPTOR.services_by_name.values():
            methods += [f"/{service.full_name}/{method.name}" for method in service.methods]
    return methods


def call(channel, method, request=b"", metadata=(), **options):
    """What became of a call of any kind with an empty request: its code, text and trailing metadata."""
    answers = channel.stream_stream(method)(iter([request]), metadata=metadata, timeout=30, **options)
    try:
        for _ in answers:
            pass
    except grpc.RpcError:
        pass
    trailers = {entry.key: entry.value for entry in answers.trailing_metadata() or ()}
    return answers.code(), answers.details(), trailers


def endless(channel, metadata=()):
    """A stream that runs until it is cancelled; its header has come. After all_methods, which finds the stubs."""
    messages = importlib.import_module("terrane.v1.terrain_pb2")
    request = messages.StreamTilesRequest(level=20, tile_size=513)
    request.terrain.recipe.seed = 1
    request.window.width = request.window.height = 1 << 17
    stream = channel.unary_stream(TILES)(request.SerializeToString(), metadata=metadata)
    next(stream)
    return stream


INFO = "/terrane.v1.InfoService/GetServerInfo"
TILES = "/terrane.v1.TerrainService/StreamTiles"
