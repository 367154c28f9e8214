"""What each member of a site may do on the wire: rules by role, and nothing else is allowed.

A rule holds for messages that the hub takes from a member (``ingress``) or passes on to it
(``egress``), on whole key expressions: a subscription is heard of only where the rule includes all
of it, so rules for reading name the pattern of a stream, and rules for publishing name keys.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args

from inhand_schemas.fields import Name, Text
from inhand_schemas.keys import Site, beside
from inhand_schemas.procedure import Procedure
from inhand_schemas.procedures import PROCEDURES
from inhand_schemas.topics import (
    EVENT,
    HEALTH,
    INFO,
    POSE,
    PREVIEW,
    RELIABLE,
    RGBD,
    SKELETONS,
    TOPICS,
    AnyTopic,
    Delivery,
)
from msgspec import Meta, Struct

CommonName = Annotated[str, Meta(pattern=r"^[a-z0-9_.]+(?![\s\S])", max_length=64)]
RoleName = Literal["camera", "tracker", "recorder", "studio", "outcomes", "viewer"]
Flow = Literal["ingress", "egress"]
Operation = Literal[
    "put",
    "declare_subscriber",
    "query",
    "reply",
    "declare_queryable",
    "liveliness_token",
    "liveliness_query",
    "declare_liveliness_subscriber",
]


@dataclass(frozen=True)
class Role:
    """What a kind of member does: as which service it runs, if any, what it publishes under names
    of its own, what it reads of its whole rig beside healths, and which procedures it answers and
    asks."""

    service: str | None
    publishes: tuple[AnyTopic, ...] = ()
    reads: tuple[AnyTopic, ...] = ()
    answers: tuple[Procedure[Any, Any], ...] = ()
    asks: tuple[Procedure[Any, Any], ...] = ()


def _of(service: str) -> tuple[Procedure[Any, Any], ...]:
    return tuple(procedure for procedure in PROCEDURES if procedure.service == service)


EVERYTHING_ELSE = tuple(topic for topic in TOPICS.values() if topic is not HEALTH)
ROLES: dict[RoleName, Role] = {
    "camera": Role("capture", (INFO, RGBD, SKELETONS, PREVIEW), answers=_of("capture")),
    "tracker": Role("tracker", (POSE,), (INFO, RGBD, SKELETONS), answers=_of("tracker")),
    "recorder": Role("recorder", (EVENT,), EVERYTHING_ELSE, answers=_of("recorder")),
    "studio": Role("studio", reads=EVERYTHING_ELSE, asks=PROCEDURES),
    "outcomes": Role("outcomes", (EVENT,), (INFO, RGBD, SKELETONS, POSE), answers=_of("outcomes")),
    "viewer": Role(None, reads=(PREVIEW, POSE, SKELETONS, INFO)),
}


class Member(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Who may take part: its name in its rig, its role, and its certificate's common name.

    A camera publishes under its own name, a tracker the poses of its ``objects``. One that joins
    ``by_password`` has no certificate, and the common name as its user.
    """

    name: Name
    rig: Name
    role: RoleName
    common_name: CommonName
    objects: tuple[Name, ...] = ()
    by_password: bool = False

    @property
    def place(self) -> Text:
        """The member as people write it, ``RIG/NAME``."""
        return f"{self.rig}/{self.name}"

    @property
    def published_names(self) -> tuple[str, ...]:
        """The names under which it publishes its role's topics."""
        return self.objects if self.role == "tracker" else (self.name,)


class LinkedHub(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A further hub of the site, which connects to the first: its name, its certificate's common
    name, under which hosts it is reached, and when that certificate ends, in seconds since the
    epoch.

    Over a ``far`` link no full pictures pass, in either direction. A hub with ``passwords`` lets
    those members in that have one, and nobody by certificate.
    """

    name: Name
    common_name: CommonName
    hosts: tuple[Text, ...]
    ends_at: float
    far: bool = False
    passwords: bool = False


@dataclass(frozen=True)
class Rule:
    """These operations are allowed in one direction, on these key expressions."""

    flow: Flow
    operations: tuple[Operation, ...]
    keys: tuple[str, ...]


def rules_of(member: Member, realm: str) -> tuple[Rule, ...]:
    """Return all that a member may do."""
    site, role = Site(realm, member.rig), ROLES[member.role]
    rules = [*_watching_rules(site), *_reading_rules(HEALTH, site)]
    if role.service is not None:
        rules += _instance_rules(site, role.service, member.name)
    for topic in role.publishes:
        rules += _publishing_rules(topic, site, member.published_names)
    for topic in role.reads:
        rules += _reading_rules(topic, site)
    rules += _procedure_rules(site, role, member.name)
    return tuple(rules)


def link_rules(realm: str, rigs: Iterable[str], *, far: bool) -> tuple[Rule, ...]:
    """Return what passes between two hubs: what the members of both may do, since each hub has let
    its own do no more. Who belongs to the site each hub says to its own members alone."""
    keys: list[str] = []
    for site in (Site(realm, rig) for rig in rigs):
        topics = [one for one in TOPICS.values() if not (far and one is RGBD)]
        keys += [topic.pattern(site) for topic in topics]
        keys += [beside(topic.pattern(site)) for topic in topics if topic.delivery.kept]
        keys += [procedure.pattern(site) for procedure in PROCEDURES]
        keys += [site.live_pattern(), site.all_claims_pattern()]
    return tuple(Rule(flow, get_args(Operation), tuple(keys)) for flow in get_args(Flow))


def deliveries(realm: str, rigs: Iterable[str]) -> list[tuple[Delivery, tuple[str, ...]]]:
    """Return how what passes a hub is delivered, by keys: as Inhand's own processes send it."""
    sites = [Site(realm, rig) for rig in rigs]
    found = []
    for topic in TOPICS.values():
        keys = [topic.pattern(site) for site in sites]
        if topic.delivery.kept:
            keys += [beside(key) for key in keys]
        found.append((topic.delivery, tuple(keys)))
    questions = [procedure.pattern(site) for procedure in PROCEDURES for site in sites]
    questions += [site.access_pattern() for site in sites]
    return [*found, (RELIABLE, tuple(questions))]


def access_control(
    realm: str, members: Sequence[Member], links: Mapping[str, tuple[Rule, ...]] | None = None
) -> dict[str, Any]:
    """Return the hub's access rules as Zenoh's settings have them: who is no member may nothing.

    All ``members`` show a certificate, or all a password. ``links`` are the rules of other hubs, by
    the common names of their certificates.
    """
    rules: list[dict[str, Any]] = []
    subjects: list[dict[str, Any]] = []
    policies: list[dict[str, Any]] = []
    users = {member.common_name for member in members if member.by_password}
    allowed = {member.common_name: rules_of(member, realm) for member in members}
    for common_name, its_rules in {**allowed, **(links or {})}.items():
        ids = []
        for number, rule in enumerate(its_rules):
            ids.append(f"{common_name} {number}")
            rules.append(
                {
                    "id": ids[-1],
                    "permission": "allow",
                    "flows": [rule.flow],
                    "messages": list(rule.operations),
                    "key_exprs": list(rule.keys),
                }
            )
        shows = "usernames" if common_name in users else "cert_common_names"
        subjects.append({"id": common_name, shows: [common_name]})
        policies.append({"rules": ids, "subjects": [common_name]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def _instance_rules(site: Site, service: str, name: str) -> list[Rule]:
    """What a daemon does under its own name: ask for access, claim the name, live, and say how it
    is."""
    live, claims = site.live_key(service, name), (site.claim_pattern(service, name),)
    access = (site.access_key(service, name),)
    return [
        Rule("ingress", ("query",), access),
        Rule("egress", ("declare_queryable", "reply"), access),
        Rule("ingress", ("liveliness_token",), (live, *claims)),
        Rule("ingress", ("liveliness_query", "declare_liveliness_subscriber"), claims),
        Rule("egress", ("liveliness_token",), claims),
        *_publishing_rules(HEALTH, site, (name,)),
    ]


def _publishing_rules(topic: AnyTopic, site: Site, names: Sequence[str]) -> list[Rule]:
    keys = tuple(topic.key(site, name) for name in names)
    if not keys:  # what a rule without keys means is not said anywhere
        return []
    rules = [
        Rule("ingress", ("put",), keys),
        Rule("egress", ("declare_subscriber",), (topic.pattern(site),)),
    ]
    if not topic.delivery.kept:
        return rules
    own = tuple(beside(key) for key in keys)
    return [
        *rules,
        Rule("ingress", ("reply",), keys),
        Rule("ingress", ("put", "declare_queryable", "liveliness_token"), own),
        Rule("egress", ("query", "declare_subscriber"), (beside(topic.pattern(site)),)),
    ]


def _reading_rules(topic: AnyTopic, site: Site) -> list[Rule]:
    pattern = (topic.pattern(site),)
    rules = [Rule("ingress", ("declare_subscriber",), pattern), Rule("egress", ("put",), pattern)]
    if not topic.delivery.kept:
        return rules
    around = (beside(topic.pattern(site)),)
    looks: tuple[Operation, ...] = (
        "query",
        "liveliness_query",
        "declare_liveliness_subscriber",
        "declare_subscriber",
    )
    return [
        *rules,
        Rule("egress", ("reply",), pattern),
        Rule("ingress", looks, around),
        Rule("egress", ("put", "declare_queryable", "liveliness_token"), around),
    ]


def _procedure_rules(site: Site, role: Role, name: str) -> list[Rule]:
    rules = []
    for procedure in role.answers:
        rules += [
            Rule("ingress", ("declare_queryable", "reply"), (procedure.key(site, name),)),
            Rule("egress", ("query",), (procedure.pattern(site),)),
        ]
    for procedure in role.asks:
        pattern = (procedure.pattern(site),)
        rules += [
            Rule("ingress", ("query",), pattern),
            Rule("egress", ("declare_queryable", "reply"), pattern),
        ]
    return rules


def _watching_rules(site: Site) -> list[Rule]:
    """What all members may: see who lives. With the healths it is what ``inhand up`` and ``inhand
    status`` go by, on every host."""
    lives = (site.live_pattern(),)
    looks: tuple[Operation, ...] = ("liveliness_query", "declare_liveliness_subscriber")
    return [Rule("ingress", looks, lives), Rule("egress", ("liveliness_token",), lives)]
