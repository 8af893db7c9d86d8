# SPDX-License-Identifier: Apache-2.0
"""Settings from keywords: settings(method="path-tracing", target_error=0.01)."""
import difflib

from flatlight.errors import BadRequest
from flatlight.v1 import settings_pb2

_FIELDS = settings_pb2.Settings.DESCRIPTOR.fields


def _plain(name):
    return name.replace("-", "").replace("_", "").lower()


def field_name(name):
    """The name in the API of a setting that is written as there, as an option or as in JSON: target_error, target-error,
    targetError."""
    for field in _FIELDS:
        if _plain(field.name) == _plain(name):
            return field.name
    raise BadRequest(f"{name}: is not a setting" + _suggestion(name, [field.name for field in _FIELDS]))


def settings(**values):
    """flatlight.v1.Settings; proto/flatlight/v1/settings.proto has meanings, units and ranges. None: not set."""
    message = settings_pb2.Settings()
    for key, value in values.items():
        name = field_name(key)
        field = message.DESCRIPTOR.fields_by_name[name]
        if value is None:
            continue
        try:
            if field.label == field.LABEL_REPEATED:
                getattr(message, name).extend([value] if isinstance(value, str) else value)
            else:
                setattr(message, name, _enum(name, field.enum_type, value) if field.enum_type else value)
        except (TypeError, ValueError) as error:
            raise BadRequest(f"{name}: is {value!r}: {error}") from None
    return message


def text(value):
    """A setting's value as people write it: "path-tracing" of PATH_TRACING."""
    return value.lower().replace("_", "-") if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else str(value)


def enum_value(enum_type, name, what):
    """The number of an enum's value by its name in any spelling."""
    choices = [value for value in enum_type.values if value.number != 0]
    for choice in choices:
        if _plain(choice.name) == _plain(str(name)):
            return choice.number
    known = [text(choice.name) for choice in choices]
    raise BadRequest(f"{what}: is {name!r}; allowed: {', '.join(known)}" + _suggestion(str(name), known))


def _enum(name, enum_type, value):
    return value if isinstance(value, int) else enum_value(enum_type, value, name)


def _suggestion(name, known):
    close = difflib.get_close_matches(name.replace("-", "_"), known, n=1)
    return f"; did you mean {close[0]}?" if close else ""
