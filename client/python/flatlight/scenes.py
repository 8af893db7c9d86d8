# SPDX-License-Identifier: Apache-2.0
"""Scenes of requests: the gallery's by name, files and dictionaries by upload under the hash of their bytes."""
import hashlib
import json
import os

import grpc
from flatlight.errors import BadRequest, Error
from flatlight.v1 import render_service_pb2, scene_pb2, scene_service_pb2
from google.protobuf import json_format

_GALLERY = "gallery:"
_CHUNK = 256 << 10  # Bytes of a message.
_MAX_RESTARTS = 100  # Others may upload the same scene; each of their chunks can make ours come too late.


def scene_bytes(scene):
    """The bytes of a scene file, of a path, a dictionary in the file's form or a flatlight.v1.Scene; None of a scene that
    the server has: gallery:NAME or scenes/NAME."""
    if isinstance(scene, scene_pb2.Scene):
        return json_format.MessageToJson(scene).encode()
    if isinstance(scene, dict):
        return json.dumps(scene).encode()
    path = os.fspath(scene)
    if path.startswith((_GALLERY, "scenes/")):
        return None
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as error:
        raise BadRequest(f"{path}: {error.strerror}; a scene is a file, gallery:NAME or a dictionary") from None


def provide(client, scene, probes=()):
    """The SceneSource of a request for `scene`, uploaded if need be. `probes`, if any, replace the scene's own."""
    source = render_service_pb2.SceneSource()
    for probe in probes:
        source.probes.append(probe if isinstance(probe, scene_pb2.Probe) else
                             json_format.ParseDict(probe, scene_pb2.Probe()))
    data = scene_bytes(scene)
    source.name = _upload(client, data) if data is not None else scene.replace(_GALLERY, "scenes/", 1)
    return source


def _upload(client, data):
    request = scene_service_pb2.UploadSceneRequest(sha256=hashlib.sha256(data).hexdigest(), total_bytes=len(data))
    restarts = 0
    while True:  # The first call, without data, asks how many bytes are there.
        try:
            response = client.call(client.scene_service.UploadScene, request)
        except Error as error:
            restarts += 1
            if error.code != grpc.StatusCode.OUT_OF_RANGE or restarts > _MAX_RESTARTS:
                raise
            request.offset, request.data = 0, b""
            continue
        if response.received_bytes >= len(data):
            return response.name
        request.offset = response.received_bytes
        request.data = data[request.offset:request.offset + _CHUNK]
