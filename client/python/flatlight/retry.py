# SPDX-License-Identifier: Apache-2.0
"""When a call that was refused, or found no server, is made again."""
import logging
import random

import grpc

MOST_TRIES = 5
_LONGEST_DELAY = 10  # s; what takes longer is for the caller to wait for.
_FIRST_WAIT, _MOST_WAIT = 0.25, 2

_log = logging.getLogger("flatlight")  # Without a handler its warnings go to standard error.


def is_repeatable(request):
    """Whether making the call twice comes to the same as making it once: its method says so in the .proto, or the request
    has a request_id by which the server knows it again."""
    if "request_id" in request.DESCRIPTOR.fields_by_name:
        return bool(request.request_id)
    for service in request.DESCRIPTOR.file.services_by_name.values():
        for method in service.methods:
            if method.input_type is request.DESCRIPTOR:
                return method.GetOptions().idempotency_level != 0
    return False


class Retry:
    """The tries of one call. A server that says when to try again has not done what was asked, so any call is made again,
    not sooner; one that found no server, or lost it, only if it is repeatable."""

    def __init__(self, request):
        self._repeatable = is_repeatable(request)
        self._tries = 0

    def next(self, error, chance=random.random):
        """Seconds to wait before the next try, after an errors.Error; None: there is none. Says so once, as a warning."""
        if error.code not in (grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.UNAVAILABLE):
            return None
        self._tries += 1
        if self._tries >= MOST_TRIES:
            return None
        if error.retry_after is not None:
            if error.retry_after > _LONGEST_DELAY:
                return None
            why, wait = f"the server refuses for now ({error.reason})", error.retry_after * (1 + 0.25 * chance()) + 0.001
        elif error.code == grpc.StatusCode.UNAVAILABLE and not error.reason and self._repeatable:
            whole = min(_MOST_WAIT, _FIRST_WAIT * 2 ** (self._tries - 1))
            why, wait = "no answer from the server", whole * (0.5 + 0.5 * chance())
        else:
            return None
        if self._tries == 1:
            _log.warning("flatlight: %s; trying again in %.2g s, up to %d times", why, wait, MOST_TRIES - 1)
        return wait
