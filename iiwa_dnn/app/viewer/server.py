"""The page's server: viser, its address, and the look of the page."""

from __future__ import annotations

import importlib
import socket
from contextlib import redirect_stdout
from io import StringIO
from typing import Any

from iiwa_dnn.errors import InvalidInputError, MissingDependencyError

HOST, PORT = "127.0.0.1", 8080
"""The local machine only, unless told otherwise."""


def import_viser() -> Any:
    """Return viser's Python package, or raise a MissingDependencyError."""
    try:
        return importlib.import_module("viser")
    except ImportError as error:
        remedy = "pip install 'iiwa-dnn[view]'"
        raise MissingDependencyError("the Python package viser", remedy) from error


def open_server(title: str, host: str, port: int) -> Any:
    """Serve an empty page.

    Args:
        title: Title above the page's controls.
        host: Address to listen on; ``"0.0.0.0"`` lets other machines in.
        port: Port to listen on; 0 takes a free one.

    Returns:
        The ``viser.ViserServer``.

    Raises:
        MissingDependencyError: If viser is not installed.
        InvalidInputError: If the address cannot be listened on.
    """
    viser = import_viser()
    port = _checked_port(host, port)
    with redirect_stdout(StringIO()):  # its banner; the command prints the address
        server = viser.ViserServer(host=host, port=port, label=title, verbose=False)
    # No logo that links to the web, and no button that asks a relay for a public address.
    server.gui.configure_theme(
        control_width="large", show_logo=False, show_share_button=False, brand_color=(255, 102, 0)
    )
    server.gui.set_panel_label(title)
    server.scene.set_up_direction("+z")
    return server


def _checked_port(host: str, port: int) -> int:
    """Return the port if it is free, or a free one for 0; viser would take another one silently."""
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
            return int(probe.getsockname()[1])
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InvalidInputError(
            "port", f"cannot listen on {host}:{port}: {reason}", port
        ) from error
