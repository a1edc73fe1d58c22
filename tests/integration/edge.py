"""What the tests of the server's edge share: certificates, keys and calls."""

import importlib
import pathlib
import subprocess
import sys

import grpc

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))

from real_server import FAR_DEADLINE_SECONDS, STUBS, endless_request  # noqa: E402

INFO = "/terrane.v1.InfoService/GetServerInfo"
TILES = "/terrane.v1.TerrainService/StreamTiles"


class Authority:
    """A certificate authority in a folder, made with the openssl command."""

    def __init__(self, folder, name):
        self.folder, self.name = pathlib.Path(folder), name
        self.certificate = self.folder / f"{name}.pem"
        self.key = self.folder / f"{name}.key"
        openssl("req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2",
                "-subj", f"/CN={name}", "-keyout", self.key, "-out", self.certificate)

    def issue(self, name, names="DNS:localhost,IP:127.0.0.1"):
        """The files of a new certificate, for localhost unless said otherwise, and of its key."""
        certificate, key, request = (self.folder / f"{self.name}-{name}{end}" for end in (".pem", ".key", ".csr"))
        openssl("req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-subj", f"/CN={name}",
                "-addext", f"subjectAltName={names}", "-keyout", key, "-out", request)
        openssl("x509", "-req", "-in", request, "-CA", self.certificate, "-CAkey", self.key, "-days", "2",
                "-copy_extensions", "copy", "-out", certificate)
        return certificate, key


def openssl(*arguments):
    done = subprocess.run(["openssl", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def key_pair(folder, name, kind, option):
    """The files of a private key and of its public one."""
    private, public = folder / f"{name}.key", folder / f"{name}.pub"
    openssl("genpkey", "-algorithm", kind, "-pkeyopt", option, "-out", private)
    openssl("pkey", "-in", private, "-pubout", "-out", public)
    return private, public


def all_methods():
    """Every rpc of terrane.v1 as its path, from the descriptors."""
    methods = []
    for file in sorted(pathlib.Path(STUBS).glob("terrane/v1/*_pb2.py")):
        module = importlib.import_module(f"terrane.v1.{file.stem}")
        for service in module.DESCRIPTOR.services_by_name.values():
            methods += [f"/{service.full_name}/{method.name}" for method in service.methods]
    return methods


def call(channel, method, request=b"", metadata=(), **options):
    """What became of a call of any kind with an empty request: its code, text and trailing metadata."""
    answers = channel.stream_stream(method)(iter([request]), metadata=metadata, timeout=FAR_DEADLINE_SECONDS, **options)
    try:
        for _ in answers:
            pass
    except grpc.RpcError:
        pass
    trailers = {entry.key: entry.value for entry in answers.trailing_metadata() or ()}
    return answers.code(), answers.details(), trailers


def endless(channel, metadata=()):
    """A stream that runs until it is cancelled; its header has come."""
    stream = channel.unary_stream(TILES)(endless_request().SerializeToString(), metadata=metadata)
    next(stream)
    return stream
