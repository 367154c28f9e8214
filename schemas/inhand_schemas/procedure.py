"""What a procedure is: a verb that instances of a service can be asked to do."""

from dataclasses import dataclass
from typing import Generic, TypeVar

import msgspec
from msgspec import Struct

from inhand_schemas.errors import MessageError
from inhand_schemas.keys import Site, require_name

Q = TypeVar("Q", bound=Struct)
R = TypeVar("R", bound=Struct)

_encoder = msgspec.msgpack.Encoder()


@dataclass(frozen=True)
class Procedure(Generic[Q, R]):
    """One verb of a service, ``{realm}/@v1/{rig}/@rpc/{service}/{verb}/{instance}``.

    ``named`` is the field of a reply that has the name of the instance.
    """

    service: str
    verb: str
    request_type: type[Q]
    reply_type: type[R]
    named: str

    def key(self, site: Site, instance: str) -> str:
        """The key that one instance of the service answers on; raises KeyFormatError."""
        require_name("instance", instance)
        return f"{self.shared_key(site)}/{instance}"

    def pattern(self, site: Site) -> str:
        """The keys of all instances, as a Zenoh key expression."""
        return f"{self.shared_key(site)}/*"

    def shared_key(self, site: Site) -> str:
        """The one key that all instances answer on as well, for programs that know no other; who is
        behind a reply on it nobody vouches for, and no hub lets it through."""
        return site.procedure_key(self.service, self.verb)

    def encode(self, message: Q | R) -> bytes:
        """A request or reply as MessagePack."""
        return _encoder.encode(message)

    def request(self, data: bytes) -> Q:
        """Decode a request; raises MessageError."""
        return _decoded(data, self.request_type)

    def reply(self, key: str, data: bytes) -> R:
        """Decode a reply that came on a key; raises MessageError, also for another's name in it."""
        reply = _decoded(data, self.reply_type)
        if key.rpartition("/")[2] != (name := getattr(reply, self.named)):
            raise MessageError(f"a reply on {key} is in the name of {name!r}")
        return reply


S = TypeVar("S", bound=Struct)


def _decoded(data: bytes, kind: type[S]) -> S:
    try:
        return msgspec.msgpack.decode(data, type=kind)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise MessageError(f"no valid {kind.__name__}: {error}") from None
