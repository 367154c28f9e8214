"""The form that asks for the password, and the cookie of who gave it."""

import logging
import math

from aiohttp import web

from inhand_studio.access.failed_logins import FailedLogins
from inhand_studio.access.headers import login_headers
from inhand_studio.access.parameters import DEFAULT_GATE
from inhand_studio.access.password import Password
from inhand_studio.access.sessions import Sessions

log = logging.getLogger(__name__)

LOGIN_PATH = "/login"

_FORM = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Inhand studio</title>
<style>
:root { color-scheme: light dark; font: 1rem/1.5 system-ui, sans-serif; }
body { display: grid; place-content: center; min-height: 90vh; margin: 1rem; }
form { display: grid; gap: .75rem; width: min(20rem, 90vw); }
h1 { font-size: 1.25rem; margin: 0; }
input, button { font: inherit; padding: .5rem; }
p { margin: 0; color: #c22; }
</style>
</head>
<body>
<form method="post" action="/login">
<h1>Inhand studio</h1>
<label for="password">Password</label>
<input id="password" name="password" type="password" autocomplete="current-password"
 required autofocus>
<p role="alert">REASON</p>
<button>Log in</button>
</form>
</body>
</html>
"""


class Login:
    """Lets in who knows the password."""

    def __init__(self, password: Password, *, encrypted: bool) -> None:
        self.failed = FailedLogins()
        self._password = password
        self._encrypted = encrypted
        self._sessions = Sessions()

    def knows(self, request: web.Request) -> bool:
        """Whether a request is from a browser that gave the password."""
        return self._sessions.knows(request.cookies.get(self._cookie(request)))

    def form(self, reason: str = "", status: int = 401, wait_s: float = 0.0) -> web.Response:
        """Return the form, with the reason why it is asked again."""
        headers = login_headers()
        if wait_s > 0.0:
            headers["Retry-After"] = str(math.ceil(wait_s))
        text = _FORM.replace("REASON", reason)
        return web.Response(text=text, status=status, content_type="text/html", headers=headers)

    async def answer(self, request: web.Request) -> web.Response:
        """Answer what the form sends: with a cookie, or with the form again."""
        given = (await request.post()).get("password")
        # No await from here on, so that of many requests at once each counts for the next.
        wait_s = self.failed.wait_s(request.remote)
        if wait_s > 0.0:
            reason = f"Too many wrong passwords: wait {math.ceil(wait_s)} seconds."
            return self.form(reason, 429, wait_s)
        if not isinstance(given, str) or not self._password.matches(given):
            self.failed.note(request.remote)
            log.warning(
                "wrong password from %s: %d failed logins so far", request.remote, self.failed.total
            )
            return self.form("This is not the password.")
        return self._let_in(request)

    def _let_in(self, request: web.Request) -> web.Response:
        headers = {**login_headers(), "Location": "/"}
        response = web.Response(status=303, headers=headers)
        response.set_cookie(
            self._cookie(request),
            self._sessions.begin(),
            max_age=int(DEFAULT_GATE.session_s),
            path="/",
            httponly=True,
            samesite="Strict",
            secure=self._encrypted,
        )
        return response

    def _cookie(self, request: web.Request) -> str:
        """Return the name of the cookie: browsers share cookies among the ports of a host."""
        port = request.url.port
        return f"__Host-inhand_studio_{port}" if self._encrypted else f"inhand_studio_{port}"
