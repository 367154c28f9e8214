"""The certificate by which the studio speaks HTTPS."""

import ssl
from typing import NoReturn

from inhand_runtime.errors import SettingsError

from inhand_studio.access.settings import AccessSettings


def tls_of(settings: AccessSettings) -> ssl.SSLContext | None:
    """Return the TLS of the certificate that the settings name, if any; raises SettingsError."""
    certificate, private_key = settings.certificate, settings.private_key
    if certificate is None or private_key is None:
        return None
    for name, path in (("certificate", certificate), ("private_key", private_key)):
        try:
            path.read_bytes()
        except OSError as error:
            raise SettingsError(f"cannot read {name} {path}: {error.strerror}") from None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)

    def encrypted() -> NoReturn:
        raise SettingsError(
            f"private_key {private_key} is encrypted: write it without a password "
            "(openssl pkey), in a file that only its user reads"
        )

    try:
        context.load_cert_chain(certificate, private_key, password=encrypted)
    except ssl.SSLError as error:
        raise SettingsError(
            f"certificate {certificate} and private_key {private_key} are no pair of PEM files: "
            f"{error.reason or 'nothing in them can be read'}"
        ) from None
    return context
