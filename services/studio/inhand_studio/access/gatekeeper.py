"""Decides for each request whether it passes, is asked for the password, or is refused."""

from aiohttp import hdrs, web

from inhand_studio.access.forwarding import Forwarder
from inhand_studio.access.hosts import host_is_known, origin_is_own
from inhand_studio.access.login import LOGIN_PATH, Login
from inhand_studio.access.terms import Terms

_PASSING = (hdrs.METH_GET, hdrs.METH_HEAD)


class Gatekeeper:
    """Answers requests by the terms: with what is behind the gate, with a form, or a refusal."""

    def __init__(self, terms: Terms, forwarder: Forwarder) -> None:
        self._terms = terms
        self._forwarder = forwarder
        self._login: Login | None = None
        if terms.password is not None:
            self._login = Login(terms.password, encrypted=terms.tls is not None)

    async def answer(self, request: web.Request) -> web.StreamResponse:
        """Answer one request."""
        self._require_own(request)
        if self._login is not None:
            at_the_form = request.path == LOGIN_PATH
            if at_the_form and request.method == hdrs.METH_POST:
                return await self._login.answer(request)
            if not self._login.knows(request):
                return self._login.form()
            if at_the_form:
                raise web.HTTPSeeOther("/")
        if request.method not in _PASSING:
            raise web.HTTPMethodNotAllowed(request.method, _PASSING)
        return await self._forwarder.forward(request)

    def _require_own(self, request: web.Request) -> None:
        """Refuse what a page of another site asks."""
        if not host_is_known(
            request.headers.get(hdrs.HOST), self._terms.names, elsewhere=self._terms.elsewhere
        ):
            raise web.HTTPMisdirectedRequest(
                text="The studio has another name: add this one to names in its settings."
            )
        origin = request.headers.get(hdrs.ORIGIN)
        needed = hdrs.UPGRADE in request.headers or request.method not in _PASSING
        if (origin is not None or needed) and not origin_is_own(origin, request.host):
            raise web.HTTPForbidden(text="A page of another site may not use the studio.")
