#!/usr/bin/python3
"""More connections than the server takes: see fault.py for what must hold after it.

Usage: connections_test.py TERRANE TERRANE_SERVER STUBS [unittest arguments]
"""

import socket

from fault import FaultTest, wait_until
from real_server import PATIENCE_SECONDS, is_open, main


class Flood(FaultTest):
    MOST = 24
    FLAGS = ("--max-connections", str(MOST))

    def flood(self, connections):
        """Connections that say nothing; one that the server resets at once is not among them."""
        flood = []
        for _ in range(connections):
            try:
                address = (self.server.host, self.server.port)
                flood.append(socket.create_connection(address, timeout=PATIENCE_SECONDS))
            except ConnectionError:
                continue
            self.addCleanup(flood[-1].close)
        return flood

    def test_connections_beyond_the_cap_cost_no_descriptor(self):
        before = most = self.server.open_files()
        flood = self.flood(300)

        def is_capped():
            nonlocal most
            most = max(most, self.server.open_files())
            return sum(map(is_open, flood)) <= self.MOST

        self.assertTrue(wait_until(is_capped), "the cap is not kept")
        # A descriptor or two for each that is let in.
        self.assertLessEqual(most - before, 2 * self.MOST + 2)

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
            with self.server.channel(**{"grpc.max_reconnect_backoff_ms": 200}) as channel:
                self.assertEqual(*self.server.golden_hash(channel, wait_for_ready=True))


class FewDescriptors(Flood):
    """The same with hardly more descriptors than connections: gRPC's own listener would never
    accept again (CVE-2023-4785)."""

    def start_server(self, *flags, **options):
        return super().start_server(*flags, **options, wrapper=("prlimit", "--nofile=96", "--"))


if __name__ == "__main__":
    main()
