#!/usr/bin/python3
"""More connections than the server takes: see fault.py for what must hold after it.

Usage: connections_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import socket
import time

from fault import FaultTest
from real_server import main


class Flood(FaultTest):
    MOST = 24
    FLAGS = ("--max-connections", str(MOST))

    def flood(self, connections):
        """Connections that say nothing; one that the server resets at once is not among them."""
        flood = []
        for _ in range(connections):
            try:
                flood.append(socket.create_connection((self.server.host, self.server.port), timeout=5))
            except ConnectionError:
                continue
            self.addCleanup(flood[-1].close)
        return flood

    def test_connections_beyond_the_cap_cost_no_descriptor(self):
        before = self.server.open_files()
        self.flood(300)
        time.sleep(0.5)
        # A descriptor or two for each that is let in.
        self.assertLessEqual(self.server.open_files() - before, 2 * self.MOST + 2)

    def test_who_is_connected_is_served_on(self):
        channel = self.channel()
        self.assertEqual(*self.server.golden_hash(channel))
        self.flood(300)
        for _ in range(5):
            self.assertEqual(*self.server.golden_hash(channel))

    def test_new_clients_are_served_as_soon_as_the_flood_is_over(self):
        for _ in range(3):
            for connection in self.flood(300):
                connection.close()
            with self.server.channel() as channel:
                self.assertEqual(*self.server.golden_hash(channel, timeout=5, wait_for_ready=True))


class FewDescriptors(Flood):
    """The same with hardly more descriptors than connections: gRPC's own listener would never
    accept again (CVE-2023-4785)."""

    def start_server(self, *flags, **options):
        return super().start_server(*flags, **options, wrapper=("prlimit", "--nofile=96", "--"))


if __name__ == "__main__":
    main()
