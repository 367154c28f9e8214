"""Headers that keep a page from asking anything of other machines, and others from showing it."""

_COMMON = {
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "X-DNS-Prefetch-Control": "off",
}

# The page unpacks its own script with WebAssembly, makes functions of text, and has workers and
# pictures from memory.
_PAGE_POLICY = (
    "default-src 'none'",
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' blob:",
    "worker-src 'self' blob:",
    "style-src 'self' 'unsafe-inline'",
    "img-src 'self' data: blob:",
    "font-src 'self' data:",
    "media-src 'self' data: blob:",
    "base-uri 'none'",
    "form-action 'self'",
    "frame-ancestors 'none'",
)
_LOGIN_POLICY = (
    "default-src 'none'",
    "style-src 'unsafe-inline'",
    "base-uri 'none'",
    "form-action 'self'",
    "frame-ancestors 'none'",
)


def page_headers(host: str) -> dict[str, str]:
    """Return the headers of what the inner server sends, for a ``Host`` that is known."""
    connections = f"connect-src 'self' ws://{host} wss://{host} data: blob:"
    return {**_COMMON, "Content-Security-Policy": "; ".join((*_PAGE_POLICY, connections))}


def login_headers() -> dict[str, str]:
    """Return the headers of the gate's own pages."""
    return {
        **_COMMON,
        "Content-Security-Policy": "; ".join(_LOGIN_POLICY),
        "Cache-Control": "no-store",
    }
