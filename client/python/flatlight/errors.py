# SPDX-License-Identifier: Apache-2.0
"""Errors of the client: what went wrong, where, and the server's reason for programs."""
import math

import grpc
from google.rpc import error_details_pb2, status_pb2

try:
    ErrorInfo = error_details_pb2.ErrorInfo
except AttributeError:  # Debian's copy of the file is older than that message.
    from google.rpc.error_info_pb2 import ErrorInfo

_DETAILS = "grpc-status-details-bin"


class Error(Exception):
    """A refused or failed call. `reason` is UPPER_SNAKE_CASE ("" if the server was not reached), `code` the
    grpc.StatusCode, `mistakes` a list of (path, description), of a scene or settings that are wrong, `retry_after` the
    seconds after which the same may succeed (None if the server says none)."""

    def __init__(self, message, code=grpc.StatusCode.UNKNOWN, reason="", mistakes=(), retry_after=None):
        super().__init__(message)
        self.code = code
        self.reason = reason
        self.mistakes = list(mistakes)
        self.retry_after = retry_after


class BadRequest(Error):
    """A scene, a setting or a name that is wrong."""


class Unreachable(Error):
    """No server answered."""


class Denied(Error):
    """Not allowed, or over a quota."""


class JobFailed(Error):
    """A job that ended without a result that was asked for."""


_KINDS = {
    grpc.StatusCode.INVALID_ARGUMENT: BadRequest,
    grpc.StatusCode.NOT_FOUND: BadRequest,
    grpc.StatusCode.ALREADY_EXISTS: BadRequest,
    grpc.StatusCode.FAILED_PRECONDITION: BadRequest,
    grpc.StatusCode.OUT_OF_RANGE: BadRequest,
    grpc.StatusCode.UNAVAILABLE: Unreachable,
    grpc.StatusCode.DEADLINE_EXCEEDED: Unreachable,
    grpc.StatusCode.UNAUTHENTICATED: Denied,
    grpc.StatusCode.PERMISSION_DENIED: Denied,
    grpc.StatusCode.RESOURCE_EXHAUSTED: Denied,
}


def error_of(rpc_error, address):
    """The Error that a grpc.RpcError of a call to `address` stands for."""
    code = rpc_error.code()
    reason, mistakes, retry_after = "", [], None
    for key, value in rpc_error.trailing_metadata() or ():
        if key == _DETAILS:
            reason, mistakes, retry_after = _details(value)
    message = "\n".join(f"{path}: {description}" for path, description in mistakes) or rpc_error.details()
    if code == grpc.StatusCode.UNAVAILABLE and not reason:
        message = f"cannot reach the server at {address}: {rpc_error.details()}"
    elif code == grpc.StatusCode.DEADLINE_EXCEEDED:
        message = f"the server at {address} did not answer in time"
    elif code == grpc.StatusCode.RESOURCE_EXHAUSTED and retry_after is not None:
        message += f" (try again in {_time_text(retry_after)})"
    return _KINDS.get(code, Error)(message, code, reason, mistakes, retry_after)


def _time_text(seconds):
    if seconds <= 120:
        return f"{math.ceil(seconds)} s"
    return f"{math.ceil(seconds / 60)} min" if seconds <= 7200 else f"{math.ceil(seconds / 3600)} h"


def _details(serialised):
    reason, mistakes, retry_after = "", [], None
    info, bad_request, retry = ErrorInfo(), error_details_pb2.BadRequest(), error_details_pb2.RetryInfo()
    for detail in status_pb2.Status.FromString(serialised).details:
        if detail.Is(info.DESCRIPTOR):
            detail.Unpack(info)
            reason = info.reason
        elif detail.Is(bad_request.DESCRIPTOR):
            detail.Unpack(bad_request)
            mistakes += [(violation.field, violation.description) for violation in bad_request.field_violations]
        elif detail.Is(retry.DESCRIPTOR):
            detail.Unpack(retry)
            retry_after = retry.retry_delay.seconds + 1e-9 * retry.retry_delay.nanos
    return reason, mistakes, retry_after
