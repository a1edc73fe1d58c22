"""Two network namespaces and a link between them that loses packets.

Each namespace has a TUN device; a thread carries the packets from one to the other and
drops some. That needs root and /dev/net/tun, but no module of the kernel for loss.
"""

import ctypes
import fcntl
import os
import random
import select
import struct
import subprocess
import threading

CLONE_NEWNET = 0x40000000
TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000
MTU = 1500
DEVICE = "terrane0"


class NoNamespaces(Exception):
    """This machine does not let one make them; the text says why."""


def ip(*arguments):
    subprocess.run(["ip", *arguments], check=True)


def add_namespace(name):
    done = subprocess.run(["ip", "netns", "add", name], capture_output=True, text=True)
    if done.returncode != 0:
        raise NoNamespaces("ip netns add: " + done.stderr.strip())


def open_tun(namespace):
    """A TUN device in a namespace. Its descriptor works from everywhere."""
    libc = ctypes.CDLL(None, use_errno=True)
    with open("/proc/thread-self/ns/net") as home, open(f"/run/netns/{namespace}") as there:
        if libc.setns(there.fileno(), CLONE_NEWNET) != 0:
            raise NoNamespaces("setns: " + os.strerror(ctypes.get_errno()))
        try:
            tun = os.open("/dev/net/tun", os.O_RDWR)
            fcntl.ioctl(tun, TUNSETIFF, struct.pack("16sH22x", DEVICE.encode(), IFF_TUN | IFF_NO_PI))
        except OSError as error:
            raise NoNamespaces(f"/dev/net/tun: {error.strerror}") from error
        finally:
            libc.setns(home.fileno(), CLONE_NEWNET)
    return tun


class LossyLink:
    """Use as a context. `near` and `far` are the namespaces, of the addresses of the same name."""

    NEAR_ADDRESS, FAR_ADDRESS = "10.199.77.1", "10.199.77.2"

    def __init__(self, loss, seed=1):
        self.loss = loss
        self.lost = self.carried = 0
        self._random = random.Random(seed)
        self.near, self.far = (f"terrane-{os.getpid()}-{end}" for end in ("near", "far"))
        self._tuns = []
        self._stop_read, self._stop_write = os.pipe()
        self._thread = threading.Thread(target=self._carry)

    def __enter__(self):
        try:
            ends = [(self.near, self.NEAR_ADDRESS, self.FAR_ADDRESS), (self.far, self.FAR_ADDRESS, self.NEAR_ADDRESS)]
            for namespace, address, peer in ends:
                add_namespace(namespace)
                self._tuns.append(open_tun(namespace))
                ip("-n", namespace, "address", "add", address, "peer", peer, "dev", DEVICE)
                ip("-n", namespace, "link", "set", DEVICE, "up", "mtu", str(MTU))
                ip("-n", namespace, "link", "set", "lo", "up")
        except Exception:
            self._remove()
            raise
        self._thread.start()
        return self

    def __exit__(self, *_):
        os.write(self._stop_write, b"x")
        self._thread.join()
        self._remove()

    def _remove(self):
        for tun in self._tuns:
            os.close(tun)
        for namespace in (self.near, self.far):
            subprocess.run(["ip", "netns", "delete", namespace], capture_output=True)
        os.close(self._stop_read)
        os.close(self._stop_write)

    def _carry(self):
        other = dict(zip(self._tuns, reversed(self._tuns)))
        while True:
            ready, _, _ = select.select([*self._tuns, self._stop_read], [], [])
            if self._stop_read in ready:
                return
            for tun in ready:
                packet = os.read(tun, 65_536)
                if self._random.random() < self.loss:
                    self.lost += 1
                else:
                    self.carried += 1
                    os.write(other[tun], packet)

    @staticmethod
    def command_in(namespace):
        """What a command starts with that runs there."""
        return ["ip", "netns", "exec", namespace]
