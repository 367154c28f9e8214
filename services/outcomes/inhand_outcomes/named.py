"""Settings that name something."""

from inhand_schemas.errors import KeyFormatError
from inhand_schemas.keys import require_name
from pydantic import AfterValidator


def named(what: str) -> AfterValidator:
    """A check that a text can be the name of something."""

    def check(name: str) -> str:
        try:
            require_name(what, name)
        except KeyFormatError as error:
            raise ValueError(str(error)) from None
        return name

    return AfterValidator(check)
