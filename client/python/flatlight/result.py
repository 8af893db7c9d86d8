# SPDX-License-Identifier: Apache-2.0
"""Results as arrays."""
import json

from flatlight.arrays import Probe, Records
from flatlight.errors import BadRequest
from flatlight.v1 import result_pb2
from google.protobuf import json_format


class Result:
    """A whole result. result["floor"] or result[0] is a Probe. records: Records of irradiance caching. message: all of it,
    a flatlight.v1.RenderResult."""

    def __init__(self, message):
        self.message = message
        self.scene = message.scene
        self.probes = [Probe(probe) for probe in message.probes]
        self.records = Records(message.records)
        self.end_reason = message.DESCRIPTOR.fields_by_name["end_reason"].enum_type.values_by_number[message.end_reason].name

    @property
    def statistics(self):
        return self.message.statistics

    @property
    def error_bound(self):
        """W/m. Of a deterministic method: no irradiance is further from the truth. None of others."""
        return self.statistics.error_bound if self.statistics.HasField("error_bound") else None

    def __getitem__(self, key):
        if isinstance(key, int):
            return self.probes[key]
        for probe in self.probes:
            if probe.name == key:
                return probe
        raise KeyError(f"{key!r} is no probe; there are: {', '.join(probe.name for probe in self.probes)}")

    def __len__(self):
        return len(self.probes)

    def save(self, path):
        """Writes the JSON form, that of `flatlight fetch -o FILE.json`; `flatlight compare` reads it."""
        text = json_format.MessageToJson(self.message, indent=None)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text + "\n")

    def __repr__(self):
        return f"<result of {self.scene!r}: {', '.join(map(repr, self.probes))}; {self.end_reason.lower().replace('_', ' ')}>"


def load(path):
    """The Result in a file that `flatlight render -o FILE.json` or Result.save wrote."""
    with open(path, encoding="utf-8") as file:
        try:
            message = json_format.ParseDict(json.load(file), result_pb2.RenderResult(), ignore_unknown_fields=True)
        except (ValueError, json_format.ParseError) as error:
            raise BadRequest(f"{path} is not a result in JSON form: {error}") from None
    if not message.probes:
        raise BadRequest(f"{path} holds no probes: is it a result in JSON form?")
    return Result(message)
