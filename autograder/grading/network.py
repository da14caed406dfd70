"""Who else can reach a Dask cluster. Whoever reaches a scheduler or worker without TLS can run any code there."""

import ipaddress
import socket

from distributed.comm import get_address_host, parse_address
from distributed.security import Security


def expect_tls_of_both(address: str) -> None:
    """Raise ValueError where the scheduler or this side alone has TLS; distributed's Client says so with a traceback."""
    scheme, _ = parse_address(address)
    own = Security().get_connection_args("client")
    if scheme == "tls" and not own.get("ssl_context"):
        raise ValueError("it speaks TLS, and there is no certificate here; copy the folder with those of the cluster")
    if scheme == "tcp" and own.get("require_encryption"):
        raise ValueError("it does not speak TLS, which is required here")


def unprotected(client):
    """The addresses of a distributed.Client's scheduler and workers that others in the network can use."""
    found = client.scheduler_info(n_workers=-1)
    return sorted(address for address in (found["address"], *found["workers"]) if is_open(address))


def is_open(address: str) -> bool:
    """Whether an address, such as tcp://host:8786, is neither encrypted nor this machine's alone."""
    scheme, _ = parse_address(address)
    if scheme in ("tls", "wss", "inproc"):
        return False
    try:
        numbers = {found[4][0] for found in socket.getaddrinfo(get_address_host(address), None)}
    except OSError:
        return True
    return not all(ipaddress.ip_address(str(number).partition("%")[0]).is_loopback for number in numbers)
