#!/usr/bin/python3
"""HAProxy with deploy/haproxy in front of two real replicas: kills, drains, an attack.

Usage: haproxy_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import concurrent.futures
import contextlib
import hashlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import grpc

TERRANE, SERVER, STUBS = sys.argv[1:4]
sys.path.insert(0, STUBS)

from terrane.v1 import common_pb2, info_pb2, info_pb2_grpc, terrain_pb2, terrain_pb2_grpc  # noqa: E402

import processes  # noqa: E402
import rapid_reset  # noqa: E402

# 64 MB: more than all buffers on the way hold.
WORLD = ["terrain", "--seed", "7", "--level", "6", "--window", "0,0,4096,4096"]
CONFIGURATION = processes.DEPLOY / "haproxy"
# For a machine that stands still at times: an attack, then a call's deadline, each a minute.
SECONDS_PER_TEST = 240
# The contract: what an attack on the proxy may cost a replica.
MOST_MIB = 50


class ConfigurationTest(unittest.TestCase):
    def check(self, replicas, **environment):
        return subprocess.run(["haproxy", "-c", "-f", CONFIGURATION / "haproxy.cfg", "-f", CONFIGURATION / replicas],
                              env={**os.environ, **environment}, capture_output=True, text=True)

    def test_both_ways_to_name_replicas_are_valid_without_a_warning(self):
        for replicas in ["replicas-static.cfg", "replicas-dns.cfg"]:
            done = self.check(replicas, TERRANE_BIND="127.0.0.1:1", HAPROXY_STATS="127.0.0.1:2", TERRANE_REPLICAS="name")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotRegex(done.stderr, "WARNING|ALERT")

    def test_a_certificate_is_part_of_where_it_listens(self):
        with tempfile.TemporaryDirectory() as folder:
            files = [f"{folder}/{name}" for name in ("key.pem", "certificate.pem", "both.pem")]
            subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=localhost", "-keyout",
                            files[0], "-out", files[1]], check=True, capture_output=True)
            pathlib.Path(files[2]).write_text("".join(pathlib.Path(f).read_text() for f in files[:2]))
            done = self.check("replicas-static.cfg", TERRANE_BIND=f"127.0.0.1:1 ssl crt {files[2]} alpn h2",
                              HAPROXY_STATS="127.0.0.1:2")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_nothing_is_bound_unless_it_is_said_where(self):
        done = self.check("replicas-static.cfg", TERRANE_BIND="", HAPROXY_STATS="127.0.0.1:2")
        self.assertEqual(done.returncode, 1)


class PausedClient:
    """terrane in the middle of WORLD, stopped; goes on when told."""

    def __init__(self, address, folder):
        self.out = folder / "world.f32"
        self.process = subprocess.Popen(
            [TERRANE, *WORLD, "--server", address, "--progress", "json", "--out", self.out],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.process.stderr.readline()
        self.process.send_signal(signal.SIGSTOP)

    def finish(self):
        """Exit code, SHA-256 of the file, what was said."""
        self.process.send_signal(signal.SIGCONT)
        _, said = self.process.communicate(timeout=60)
        return self.process.returncode, sha256(self.out), said


def sha256(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


class HaproxyTest(unittest.TestCase):
    def setUp(self):
        def too_long(*_):
            raise TimeoutError(f"the test took more than {SECONDS_PER_TEST} s")

        signal.signal(signal.SIGALRM, too_long)
        signal.alarm(SECONDS_PER_TEST)
        self.addCleanup(signal.alarm, 0)
        self.replicas = []
        self.addCleanup(self.stop_replicas)
        for _ in range(2):
            self.replicas.append(processes.Replica(SERVER, "--trust-forwarded-for"))
        self.proxy = processes.Proxy(self.replicas)
        self.addCleanup(self.proxy.stop)
        temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(temporary.name)
        self.addCleanup(temporary.cleanup)

    def stop_replicas(self):
        for replica in self.replicas:
            if replica.process.poll() is None:
                self.assertEqual(replica.stop(), 0)

    def local_hash(self):
        """The hash of WORLD as a single process writes it."""
        out = self.folder / "local.f32"
        subprocess.run([TERRANE, *WORLD, "--local", "--out", out], check=True, capture_output=True, timeout=60)
        return sha256(out)

    def paused_client(self):
        """A stopped client and the number of the replica that its stream is on."""
        client = PausedClient(self.proxy.address, self.folder)
        processes.wait_until(lambda: sum(map(self.proxy.streams, (0, 1))) == 1, "one stream, on one of the replicas")
        return client, 0 if self.proxy.streams(0) else 1

    def test_streams_of_one_connection_go_to_both_replicas(self):
        with grpc.insecure_channel(self.proxy.address) as channel:
            info = info_pb2_grpc.InfoServiceStub(channel)
            for _ in range(20):
                info.GetServerInfo(info_pb2.GetServerInfoRequest(), timeout=60)
        served = [self.proxy.number("haproxy_server_sessions_total", replica) for replica in (0, 1)]
        self.assertEqual(sum(served), 20)
        self.assertGreater(min(served), 5)

    def test_killed_replica_costs_a_stream_nothing(self):
        client, replica = self.paused_client()
        self.replicas[replica].kill()
        code, digest, said = client.finish()
        self.assertEqual(code, 0, said)
        self.assertEqual(digest, self.local_hash())
        self.assertGreaterEqual(self.proxy.number("haproxy_server_sessions_total", 1 - replica), 1)
        processes.wait_until(lambda: not self.proxy.up(replica), "the killed replica seen as down")
        self.replicas[replica].start()
        processes.wait_until(lambda: self.proxy.up(replica), "the replica back")

    def test_drained_replica_costs_nobody_a_call(self):
        client, replica = self.paused_client()
        with load(self.proxy.address) as failures:
            time.sleep(1)
            self.replicas[replica].process.send_signal(signal.SIGTERM)
            time.sleep(4)
            code, digest, said = client.finish()
        self.assertEqual(failures.calls[0], [])
        self.assertGreater(failures.calls[1], 20)
        self.assertEqual(code, 0, said)
        self.assertEqual(digest, self.local_hash())
        self.assertEqual(self.replicas[replica].process.wait(100), 0)

    def test_a_client_that_goes_away_is_gone_for_the_replica(self):
        client, replica = self.paused_client()
        client.process.kill()
        client.process.communicate()
        processes.wait_until(lambda: self.proxy.streams(replica) == 0, "the proxy without the stream")

        def cancelled():
            _, text = processes.get(self.replicas[replica].url("/metrics"))
            return any(line.startswith("terrane_rpc_total{") and 'code="CANCELLED"' in line for line in text.splitlines())

        processes.wait_until(cancelled, "a call that the replica counts as cancelled")

    def test_only_grpc_goes_through(self):
        done = subprocess.run(["curl", "--silent", "--http2-prior-knowledge", "--output", os.devnull, "--write-out",
                               "%{http_code}", f"http://{self.proxy.address}/"], capture_output=True, text=True)
        self.assertEqual(done.stdout, "415")

    def test_rapid_reset_stays_at_the_proxy(self):
        seconds, resets, attackers = 5, 20_000, 4
        # Each asks for 16 GiB of heights.
        request = terrain_pb2.StreamTilesRequest(level=16, window=common_pb2.Window(width=65536, height=65536))
        request.terrain.recipe.seed = 5
        before = most = [replica.resident_mib() for replica in self.replicas]
        with concurrent.futures.ProcessPoolExecutor(attackers) as pool, load(self.proxy.address) as polite:
            attacks = [pool.submit(rapid_reset.attack, self.proxy.port, "/terrane.v1.TerrainService/StreamTiles",
                                   request.SerializeToString(), seconds, resets // attackers) for _ in range(attackers)]
            while not all(attack.done() for attack in attacks):
                most = [max(m, r.resident_mib()) for m, r in zip(most, self.replicas)]
                time.sleep(0.05)
        sent = sum(attack.result() for attack in attacks)
        print(f"{sent} streams reset; MiB before {before}, at most {most}; {polite.calls[1]} polite calls")
        self.assertGreaterEqual(sent, resets)
        for at_first, at_most in zip(before, most):
            self.assertLess(at_most, at_first + MOST_MIB)
        # Who comes from elsewhere was served all the while.
        self.assertGreater(polite.calls[1], 20)
        self.assertLessEqual(len(polite.calls[0]), 0.05 * polite.calls[1], polite.calls[0])

    def test_a_continuation_flood_stays_at_the_proxy(self):
        before = [replica.resident_mib() for replica in self.replicas]
        block = rapid_reset.header_block(__method="POST", __scheme="http", __path="/terrane.v1.TerrainService/StreamTiles",
                                         __authority="localhost", content_type="application/grpc", te="trailers")
        more = rapid_reset.frame(rapid_reset.CONTINUATION, 0, 1, rapid_reset.header_block(x_evil="x" * 120)) * 500
        sent = 0
        with load(self.proxy.address) as polite:
            for _ in range(8):
                with rapid_reset.connect(self.proxy.port) as attacker:
                    try:
                        # Headers that never end.
                        attacker.sendall(rapid_reset.PREFACE + rapid_reset.frame(rapid_reset.SETTINGS, 0, 0)
                                         + rapid_reset.frame(rapid_reset.HEADERS, 0, 1, block))
                        while sent < 64 << 20:
                            attacker.sendall(more)
                            sent += len(more)
                    except OSError:
                        pass  # cut off
        self.assertLess(sent, 64 << 20)
        for at_first, replica in zip(before, self.replicas):
            self.assertLess(replica.resident_mib(), at_first + MOST_MIB)
        self.assertGreater(polite.calls[1], 0)
        self.assertEqual(polite.calls[0], [])


class Load:
    """Small streams, one after another on each of four channels, without any retry."""

    def __init__(self, address, deadline):
        self.address, self.deadline, self.stopped = address, deadline, threading.Event()
        self.pool = concurrent.futures.ThreadPoolExecutor(4)
        self.running = [self.pool.submit(self.run) for _ in range(4)]

    def run(self):
        request = terrain_pb2.StreamTilesRequest(window=common_pb2.Window(width=65, height=65))
        request.terrain.recipe.seed = 5
        failures, calls = [], 0
        with grpc.insecure_channel(self.address, [("grpc.use_local_subchannel_pool", 1), ("grpc.enable_retries", 0)]) as channel:
            stub = terrain_pb2_grpc.TerrainServiceStub(channel)
            while not self.stopped.is_set():
                try:
                    list(stub.StreamTiles(request, timeout=self.deadline))
                except grpc.RpcError as error:
                    failures.append(f"{error.code()}: {error.details()}")
                calls += 1
                time.sleep(0.01)
        return failures, calls

    def finish(self):
        """Failures and the number of calls."""
        self.stopped.set()
        results = [each.result(self.deadline + 60) for each in self.running]
        self.pool.shutdown()
        self.calls = sum((r[0] for r in results), []), sum(r[1] for r in results)


@contextlib.contextmanager
def load(address, deadline=60):
    """Load while the block runs; what it saw is in `calls` afterwards."""
    running = Load(address, deadline)
    try:
        yield running
    finally:
        running.finish()


if __name__ == "__main__":
    if not shutil.which("haproxy"):
        print("SKIPPED, NOTHING WAS CHECKED: there is no haproxy on this machine.", file=sys.stderr)
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
