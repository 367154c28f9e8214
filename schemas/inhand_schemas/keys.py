"""Keys, ``{realm}/@v1/{rig}/{stream}/{name}``: the only place that builds or parses one."""

import re
from dataclasses import dataclass

from inhand_schemas.errors import KeyFormatError, UnknownVersionError
from inhand_schemas.fields import NAME_PATTERN

VERSION = 1
_NAME = re.compile(NAME_PATTERN)
_VERSION_CHUNK = re.compile(r"@v(\d{1,9})")


@dataclass(frozen=True)
class Site:
    """Where keys are rooted: the realm (a site) and the rig (a host or a camera group)."""

    realm: str = "inhand"
    rig: str = "rig"

    def __post_init__(self) -> None:
        require_name("realm", self.realm)
        require_name("rig", self.rig)

    def key(self, stream: str, name: str) -> str:
        """The key of one stream; raises KeyFormatError."""
        require_name("stream", stream)
        require_name("name", name)
        return f"{self._root}/{stream}/{name}"

    def pattern(self, stream: str = "*") -> str:
        """All names of a stream (or all streams) of this rig, as a Zenoh key expression."""
        if stream != "*":
            require_name("stream", stream)
        return f"{self._root}/{stream}/*"

    def live_key(self, service: str, instance: str) -> str:
        """The key of an instance's liveliness token; raises KeyFormatError."""
        return self._of_service("@live", service, "instance", instance)

    def live_pattern(self) -> str:
        """All liveliness tokens of this rig, as a Zenoh key expression."""
        return f"{self._root}/@live/*/*"

    def claim_key(self, service: str, instance: str, phase: str, claim: str) -> str:
        """The key of the token by which a process claims a name; raises KeyFormatError."""
        for what, name in (("phase", phase), ("claim", claim)):
            require_name(what, name)
        return f"{self._claims(service, instance)}/{phase}/{claim}"

    def claim_pattern(self, service: str, instance: str, phase: str = "*") -> str:
        """The claims to a name in one phase, or in all, as a Zenoh key expression."""
        if phase != "*":
            require_name("phase", phase)
        return f"{self._claims(service, instance)}/{phase}/*"

    def all_claims_pattern(self) -> str:
        """The claims to all names of this rig, as a Zenoh key expression."""
        return f"{self._root}/@claim/*/*/*/*"

    def _claims(self, service: str, instance: str) -> str:
        return self._of_service("@claim", service, "instance", instance)

    def procedure_key(self, service: str, verb: str) -> str:
        """The key on which all instances of a service can be asked; raises KeyFormatError."""
        return self._of_service("@rpc", service, "verb", verb)

    def access_key(self, service: str, instance: str) -> str:
        """The key on which a hub answers an instance that may be what it is."""
        return self._of_service("@access", service, "instance", instance)

    def access_pattern(self) -> str:
        """The keys on which a hub answers all of this rig, as a Zenoh key expression."""
        return f"{self._root}/@access/*/*"

    def pattern_of_version(self, version: int) -> str:
        """All that another version of Inhand publishes for this rig, as a Zenoh key expression."""
        return f"{self.realm}/@v{version}/{self.rig}/*/*"

    def _of_service(self, kind: str, service: str, what: str, name: str) -> str:
        require_name("service", service)
        require_name(what, name)
        return f"{self._root}/{kind}/{service}/{name}"

    @property
    def _root(self) -> str:
        return f"{self.realm}/@v{VERSION}/{self.rig}"


def beside(key: str) -> str:
    """All that Zenoh itself exchanges beside a key, or pattern, of a kept stream."""
    return f"{key}/@adv/**"


@dataclass(frozen=True)
class ParsedKey:
    """A key taken apart."""

    site: Site
    stream: str
    name: str


def parse_key(key: str) -> ParsedKey:
    """Take a stream's key apart; raises KeyFormatError, or UnknownVersionError."""
    chunks = key.split("/")
    if len(chunks) != 5:
        raise KeyFormatError(f"{key!r} is no key of the form realm/@v{VERSION}/rig/stream/name")
    realm, version, rig, stream, name = chunks
    match = _VERSION_CHUNK.fullmatch(version)
    if match is None:
        raise KeyFormatError(f"{key!r} has no version: write @v{VERSION} after the realm")
    if int(match[1]) != VERSION:
        raise UnknownVersionError(
            f"{key!r} is of version {match[1]}, and this release reads version {VERSION}: "
            "update the older side"
        )
    require_name("stream", stream)
    require_name("name", name)
    return ParsedKey(Site(realm, rig), stream, name)


def parse_live_key(key: str) -> tuple[str, str]:
    """The service and instance of a liveliness token's key; raises KeyFormatError."""
    chunks = key.split("/")
    if len(chunks) != 6 or chunks[3] != "@live":
        raise KeyFormatError(f"{key!r} is no key of a liveliness token")
    require_name("service", chunks[4])
    require_name("instance", chunks[5])
    return chunks[4], chunks[5]


def parse_claim(key: str) -> str:
    """The claim in the key of a claim's token; raises KeyFormatError."""
    chunks = key.split("/")
    if len(chunks) != 8 or chunks[3] != "@claim":
        raise KeyFormatError(f"{key!r} is no key of a claim")
    require_name("claim", chunks[7])
    return chunks[7]


def require_name(what: str, name: str) -> None:
    """Raise KeyFormatError unless ``name`` is one valid chunk of a key."""
    if not _NAME.fullmatch(name) or len(name) > 64:
        raise KeyFormatError(
            f"{what} {name!r} is no name: use 1 to 64 of the letters a-z, digits and underscore"
        )
