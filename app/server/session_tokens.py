"""Signed tokens of sessions: the page receives a token, and its WebSocket must send it back.

A token has a compressed part. Bokeh signs tokens only if two of its settings are set before its import, and decompresses
unsigned tokens of any size. This server signs all tokens, with Bokeh's key or a key of its own, and decompresses a token only if
the signature is valid.

Bokeh lets tokens expire by the wall clock, which may be set, and refuses expired tokens of sessions that are still open. This
server measures the age of a token on the monotonic clock of the machine, and refuses an old token only if its session has ended.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from typing import Any

from bokeh.server.tornado import BokehTornado
from bokeh.util.token import (
    check_token_signature,
    generate_jwt_token,
    generate_secret_key,
    generate_session_id,
    get_token_payload,
)
from tornado.httputil import HTTPServerRequest

from app.state.permalink import PARAMETERS, unknown_parameters

# WebSocket subprotocol of Bokeh.
_SUBPROTOCOL = "bokeh"
# Arguments of a request from which Bokeh reads a token or a session id.
_TOKEN = "bokeh-token"
_SESSION_ID = "bokeh-session-id"
# Entry of a token's payload: the time of issue on the monotonic clock, in seconds.
_ISSUED = "issued"
# Lifetime for which Bokeh accepts a token, in seconds: ten years, so that only this server decides.
_BOKEH_EXPIRATION = 10 * 365 * 24 * 3600

# Signs the tokens if the operator has set no key for Bokeh. A new start of the server makes a new key.
_own_key = generate_secret_key().encode()


def issue_token(
    application: BokehTornado,
    request: HTTPServerRequest,
    extra: Mapping[str, Any],
    clock: Callable[[], float] = time.monotonic,
) -> str:
    """Return a signed token of a new session.

    Parameters
    ----------
    application
        The server's web application.
    request
        The request for the page. The token contains its link parameters, the names of some unknown parameters and, with a
        login, its cookies. The session needs nothing else of the request.
    extra
        Additional entries of the token's payload.
    clock
        Monotonic clock, in seconds.
    """
    arguments = {name: request.arguments[name][:1] for name in PARAMETERS if name in request.arguments}
    arguments |= {name: [b""] for name in unknown_parameters(request.arguments)}
    has_login = bool(application.auth_provider.endpoints)
    cookies = {name: morsel.value for name, morsel in request.cookies.items()} if has_login else {}
    key = _signing_key(application)
    return generate_jwt_token(
        generate_session_id(key, signed=True),
        key,
        signed=True,
        extra_payload={"headers": {}, "cookies": cookies, "arguments": arguments, _ISSUED: clock(), **extra},
        expiration=_BOKEH_EXPIRATION,
    )


def may_begin_session(application: BokehTornado, token: str, clock: Callable[[], float] = time.monotonic) -> bool:
    """Whether a token with a valid signature is young enough to begin a session."""
    age: float = clock() - get_token_payload(token).get(_ISSUED, math.inf)
    # After a restart of the machine, the age of an earlier token may be negative.
    return bool(0.0 <= age < application.session_token_expiration)


def use_token(request: HTTPServerRequest, token: str) -> None:
    """Make Bokeh use this token for the session of a request, in place of any token or session id from the client."""
    request.arguments.pop(_SESSION_ID, None)
    request.arguments[_TOKEN] = [token.encode()]


def has_signed_token(application: BokehTornado, request: HTTPServerRequest) -> bool:
    """Whether the request for a WebSocket has a token with a valid signature. The token is not decompressed."""
    subprotocols = [name.strip() for name in request.headers.get("Sec-WebSocket-Protocol", "").split(",")]
    if len(subprotocols) != 2 or subprotocols[0] != _SUBPROTOCOL:
        return False
    try:
        return bool(check_token_signature(subprotocols[1], _signing_key(application), signed=True))
    except (ValueError, TypeError, KeyError, AttributeError, AssertionError, RecursionError):
        # The value is not a token.
        return False


def _signing_key(application: BokehTornado) -> bytes:
    """Return the key with which this server signs tokens."""
    return application.secret_key or _own_key
