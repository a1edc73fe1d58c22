"""Real processes for the tests of deploy/: replicas, HAProxy in front of them, their metrics.

Everything listens on the loopback address and is ended by its own process id.
"""

import itertools
import os
import pathlib
import random
import signal
import socket
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

DEPLOY = pathlib.Path(__file__).resolve().parents[2] / "deploy"


def free(port):
    """Whether nobody has that port of the loopback address."""
    with socket.socket() as it:
        try:
            it.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def free_ports(count):
    """Ports of the loopback address that nobody listens on, all different.

    Below those that Linux hands out (32768 and up), so that none is somebody else's by the time it is used.
    """
    return list(itertools.islice(filter(free, random.sample(range(10000, 30000), 1000)), count))


def get(url):
    """Status and text of a plain HTTP GET; (0, "") when nobody answers."""
    try:
        with urllib.request.urlopen(url, timeout=30) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()
    except OSError:
        return 0, ""


def wait_until(condition, what, seconds=60):
    """Waits for a condition; an AssertionError that says what did not come."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError(f"not within {seconds} s: {what}")


class Replica:
    """A terrane-server with its HTTP port, ready when made."""

    def __init__(self, program, *flags):
        self.program, self.flags = program, flags
        self.port, self.http_port = free_ports(2)
        self.start()

    def start(self):
        """Starts it, also again, on the ports that it had."""
        # Freed memory is free at once under AddressSanitizer, too.
        sanitizer = ":".join(filter(None, [os.environ.get("ASAN_OPTIONS"), "quarantine_size_mb=8"]))
        self.process = subprocess.Popen(
            [self.program, "--listen", f"127.0.0.1:{self.port}", "--http-listen", f"127.0.0.1:{self.http_port}",
             "--log-level", "error", *self.flags],
            stdout=subprocess.DEVNULL, env={**os.environ, "ASAN_OPTIONS": sanitizer})
        try:
            wait_until(lambda: self.process.poll() is not None or get(self.url("/readyz"))[0] == 200, "a ready replica")
            if self.process.poll() is not None:
                raise AssertionError(f"terrane-server ended with {self.process.returncode}")
        except AssertionError:
            self.kill()
            raise

    def url(self, path):
        return f"http://127.0.0.1:{self.http_port}{path}"

    def resident_mib(self):
        """The resident set, in MiB."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(status.split("VmRSS:")[1].split()[0]) / 1024

    def kill(self):
        """kill -9."""
        self.process.kill()
        self.process.wait(60)

    def stop(self):
        """SIGTERM; the exit code. Nothing happens to one that has ended."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(100)


class Proxy:
    """HAProxy with the configuration of deploy/haproxy in front of replicas."""

    def __init__(self, replicas):
        self.port, self.stats_port = free_ports(2)
        self.folder = tempfile.TemporaryDirectory()
        servers = [f"    server replica{n} 127.0.0.1:{r.port} check-proto h1 port {r.http_port}\n"
                   for n, r in enumerate(replicas)]
        backend = pathlib.Path(self.folder.name) / "replicas.cfg"
        backend.write_text("backend terrane from to_replicas\n" + "".join(servers), encoding="ascii")
        self.log = open(pathlib.Path(self.folder.name) / "log", "w+", encoding="utf-8")
        self.process = subprocess.Popen(
            ["haproxy", "-db", "-f", DEPLOY / "haproxy" / "haproxy.cfg", "-f", backend], stdout=self.log,
            stderr=subprocess.STDOUT, env={**os.environ, "TERRANE_BIND": f"127.0.0.1:{self.port}",
                                           "HAPROXY_STATS": f"127.0.0.1:{self.stats_port}"})
        try:
            wait_until(lambda: self.up(0) and self.up(len(replicas) - 1), "replicas that HAProxy sees as up")
        except AssertionError:
            self.stop()
            raise

    @property
    def address(self):
        return f"127.0.0.1:{self.port}"

    def number(self, metric, replica, **labels):
        """A number that HAProxy reports of a replica."""
        _, text = get(f"http://127.0.0.1:{self.stats_port}/metrics")
        wanted = {"proxy": "terrane", "server": f"replica{replica}", **labels}
        inside = ",".join(f'{name}="{value}"' for name, value in wanted.items())
        found = [line.split()[-1] for line in text.splitlines() if line.startswith(f"{metric}{{{inside}}}")]
        return float(found[0]) if found else None

    def up(self, replica):
        return self.number("haproxy_server_status", replica, state="UP") == 1

    def streams(self, replica):
        """Streams that a replica has now."""
        return self.number("haproxy_server_current_sessions", replica)

    def stop(self):
        self.process.terminate()
        self.process.wait(60)
        self.log.close()
        self.folder.cleanup()
