"""Forwards requests and WebSockets to the inner server, no faster than who asks can read."""

import asyncio
from contextlib import suppress

from aiohttp import (
    ClientError,
    ClientSession,
    ClientTimeout,
    ClientWebSocketResponse,
    ClientWSTimeout,
    DummyCookieJar,
    TCPConnector,
    WSCloseCode,
    WSMsgType,
    hdrs,
    web,
)
from yarl import URL

from inhand_studio.access.headers import page_headers
from inhand_studio.access.parameters import DEFAULT_GATE

_ASKED = (hdrs.ACCEPT, hdrs.ACCEPT_ENCODING, hdrs.IF_MODIFIED_SINCE, hdrs.IF_NONE_MATCH)
_ANSWERED = (
    hdrs.CONTENT_ENCODING,
    hdrs.CONTENT_LENGTH,
    hdrs.CONTENT_TYPE,
    hdrs.ETAG,
    hdrs.LAST_MODIFIED,
)

AnySocket = ClientWebSocketResponse | web.WebSocketResponse

_OWN_CODES = (WSCloseCode.OK, WSCloseCode.ABNORMAL_CLOSURE, 1005, 1015)
"""Codes of an end that are never sent as they are."""


class Forwarder:
    """Asks the inner server what browsers ask; one piece is under way for each at a time."""

    def __init__(self, inner: tuple[str, int]) -> None:
        host, port = inner
        self._inner = URL.build(scheme="http", host=host, port=port)
        # Each connection is a new one: a kept one that the inner server ends meanwhile would
        # fail a request that is right. Cookies are the gate's own and go no further.
        self._session = ClientSession(
            connector=TCPConnector(limit=0, force_close=True),
            timeout=ClientTimeout(total=None, sock_connect=DEFAULT_GATE.connecting_s),
            auto_decompress=False,
            cookie_jar=DummyCookieJar(),
        )
        self._ended = asyncio.get_running_loop().create_future()

    async def close(self) -> None:
        """End all connections."""
        self._ended.set_result(None)
        await self._session.close()

    async def forward(self, request: web.Request) -> web.StreamResponse:
        """Answer as the inner server does; with 502 where it does not."""
        try:
            if request.headers.get(hdrs.UPGRADE, "").lower() == "websocket":
                return await self._forward_socket(request)
            return await self._forward_request(request)
        except (ClientError, TimeoutError) as error:
            if _is_gone(request):
                return web.Response()  # which nobody gets
            raise web.HTTPBadGateway(text="The pages of the studio do not answer.") from error

    async def _forward_request(self, request: web.Request) -> web.StreamResponse:
        headers = {name: request.headers[name] for name in _ASKED if name in request.headers}
        asked = self._session.request(
            request.method, self._address(request), headers=headers, allow_redirects=False
        )
        async with asked as inner:
            answer = web.StreamResponse(status=inner.status, headers=page_headers(request.host))
            for name in _ANSWERED:
                if name in inner.headers:
                    answer.headers[name] = inner.headers[name]
            await answer.prepare(request)
            async for piece in inner.content.iter_chunked(DEFAULT_GATE.piece_bytes):
                await answer.write(piece)
            await answer.write_eof()
        return answer

    async def _forward_socket(self, request: web.Request) -> web.StreamResponse:
        offered = request.headers.get(hdrs.SEC_WEBSOCKET_PROTOCOL, "")
        protocols = tuple(one.strip() for one in offered.split(",") if one.strip())
        closing = ClientWSTimeout(ws_close=DEFAULT_GATE.closing_s)
        async with self._session.ws_connect(
            self._address(request), protocols=protocols, timeout=closing, max_msg_size=0
        ) as inner:
            browser = web.WebSocketResponse(
                protocols=() if inner.protocol is None else (inner.protocol,),
                heartbeat=DEFAULT_GATE.heartbeat_s,
                max_msg_size=DEFAULT_GATE.largest_message_bytes,
                timeout=DEFAULT_GATE.closing_s,
                compress=False,
            )
            await browser.prepare(request)
            try:
                await self._carry_both_ways(inner, browser)
                await asyncio.gather(
                    _end(browser, inner.close_code), _end(inner, browser.close_code)
                )
            finally:
                if request.transport is not None:
                    request.transport.abort()  # what a browser did not read by now it does not get
        return browser

    def _address(self, request: web.Request) -> URL:
        """Return where the inner server has what is asked for; it alone is ever asked."""
        path, query = request.rel_url.raw_path, request.rel_url.raw_query_string
        if not path.startswith("/"):
            raise web.HTTPBadRequest(text="This is no path.")
        return self._inner.join(URL.build(path=path, query_string=query, encoded=True))

    async def _carry_both_ways(self, inner: AnySocket, browser: AnySocket) -> None:
        """Carry messages until one side ends, or the gate."""
        ways = [asyncio.ensure_future(_carry(inner, browser))]
        ways.append(asyncio.ensure_future(_carry(browser, inner)))
        try:
            await asyncio.wait((*ways, self._ended), return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in ways:
                way.cancel()
            await asyncio.gather(*ways, return_exceptions=True)


def _is_gone(request: web.Request) -> bool:
    return request.transport is None or request.transport.is_closing()


async def _carry(source: AnySocket, target: AnySocket) -> None:
    """Carry messages one way until either side ends: the next is read when the last is sent."""
    with suppress(ClientError, ConnectionError):  # one side is gone, which is an end as well
        async for message in source:
            if message.type is WSMsgType.BINARY:
                await target.send_bytes(message.data)
            elif message.type is WSMsgType.TEXT:
                await target.send_str(message.data)


async def _end(socket: AnySocket, code: int | None) -> None:
    """End one side as the other ended, with patience for one that does not read."""
    sent = WSCloseCode.OK if code is None or code in _OWN_CODES else code
    with suppress(TimeoutError):
        async with asyncio.timeout(DEFAULT_GATE.closing_s):
            await socket.close(code=sent)
