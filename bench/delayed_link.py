"""bench/delayed_link.py NAMESPACE_A NAMESPACE_B SECONDS: a network device `pw` in each of two network namespaces; what goes
into one comes out of the other so many seconds later. As tc netem does, which not every kernel has. Root only."""
import collections
import ctypes
import fcntl
import os
import select
import struct
import sys
import time

TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 1, 0x1000


def device(namespace):
    with open(f"/var/run/netns/{namespace}", "rb") as file:
        if ctypes.CDLL(None, use_errno=True).setns(file.fileno(), 0) != 0:
            raise OSError(ctypes.get_errno(), f"namespace {namespace} cannot be entered")
    tun = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tun, TUNSETIFF, struct.pack("16sH", b"pw", IFF_TUN | IFF_NO_PI))
    return tun


def main():
    ends = [device(sys.argv[1]), device(sys.argv[2])]
    delay = float(sys.argv[3])
    to = {ends[0]: ends[1], ends[1]: ends[0]}
    waiting = collections.deque()  # (when, to, packet), in order: all wait as long
    while True:
        rest = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
        for end in select.select(ends, [], [], rest)[0]:
            waiting.append((time.monotonic() + delay, to[end], os.read(end, 65536)))
        while waiting and waiting[0][0] <= time.monotonic():
            _, end, packet = waiting.popleft()
            try:
                os.write(end, packet)
            except OSError:
                pass  # that end is not up yet: the packet is lost, as on a cable


main()
