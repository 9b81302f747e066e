"""Run nginx with deploy/nginx.conf on the loopback interface. Only names, paths and ports are replaced.

Visitors of one machine can have addresses of their own, in the header `ADDRESS_HEADER`.
"""

from __future__ import annotations

import base64
import os
import shutil
import ssl
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.browser.served_app import Output, free_port
from tests.waiting import SECONDS

ROOT = Path(__file__).parents[2]
NAME, PASSWORD = "visitor", "open sesame"
ADDRESS_HEADER = "X-Visitor-Address"
_CONFIGURATION = """
daemon off;
{user}
pid {folder}/pid;
error_log stderr notice;
events {{}}
http {{
    access_log off;
    set_real_ip_from 127.0.0.1;
    real_ip_header {header};
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
    include {folder}/site.conf;
}}
"""


@dataclass(frozen=True)
class Proxy:
    """Ports and certificate of a running proxy."""

    plain_port: int
    port: int
    certificate: Path

    @property
    def origin(self) -> str:
        return f"https://127.0.0.1:{self.port}"

    def ssl_context(self) -> ssl.SSLContext:
        """Return an SSL context that accepts the certificate."""
        return ssl.create_default_context(cafile=str(self.certificate))


def nginx() -> str | None:
    """Return the path of nginx, which Debian installs outside the PATH of normal users."""
    return shutil.which("nginx") or shutil.which("nginx", path="/usr/sbin:/usr/local/sbin")


def authorization(password: str = PASSWORD) -> dict[str, str]:
    return {"Authorization": "Basic " + base64.b64encode(f"{NAME}:{password}".encode()).decode()}


@contextmanager
def proxied(program: str, folder: Path, port: int, backends: tuple[int, int]) -> Iterator[Proxy]:
    """Run nginx in front of two backends with a new certificate and password."""
    proxy = Proxy(free_port(), port, folder / "certificate.pem")
    _make_certificate(folder)
    hashed = subprocess.run(["openssl", "passwd", "-apr1", PASSWORD], check=True, capture_output=True, text=True).stdout
    (folder / "passwords").write_text(f"{NAME}:{hashed}")
    (folder / "site.conf").write_text(_configured(proxy, folder, backends))
    (folder / "nginx.conf").write_text(_CONFIGURATION.format(folder=folder, user=_user(), header=ADDRESS_HEADER))
    command = [program, "-e", "stderr", "-c", str(folder / "nginx.conf")]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    output = Output(process.stderr, folder / "error.log")
    try:
        output.wait_for("start worker process ")
        yield proxy
    finally:
        process.terminate()
        process.wait(SECONDS)
        output.close()


def _user() -> str:
    """Keep the workers of root's nginx as root, because the default user cannot read the test folder."""
    return "user root root;" if os.getuid() == 0 else ""


def _make_certificate(folder: Path) -> None:
    command = "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=127.0.0.1"
    command += f" -addext subjectAltName=IP:127.0.0.1 -keyout {folder}/key.pem -out {folder}/certificate.pem"
    subprocess.run(command.split(), check=True, capture_output=True)


def _configured(proxy: Proxy, folder: Path, backends: tuple[int, int]) -> str:
    text = (ROOT / "deploy" / "nginx.conf").read_text()
    replacements = {
        "listen 80;": f"listen 127.0.0.1:{proxy.plain_port};",
        "listen 443 ssl;": f"listen 127.0.0.1:{proxy.port} ssl;",
        "server_name maps.example.org;": "server_name 127.0.0.1;",
        "/etc/ssl/explorer/fullchain.pem": str(folder / "certificate.pem"),
        "/etc/ssl/explorer/privkey.pem": str(folder / "key.pem"),
        "/etc/nginx/explorer.htpasswd": str(folder / "passwords"),
        "server 127.0.0.1:5006 ": f"server 127.0.0.1:{backends[0]} ",
        "server 127.0.0.1:5007 ": f"server 127.0.0.1:{backends[1]} ",
    }
    for old, new in replacements.items():
        assert old in text, f"deploy/nginx.conf has no {old!r} any more"
        text = text.replace(old, new)
    return text
