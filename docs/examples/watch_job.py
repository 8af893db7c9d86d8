# SPDX-License-Identifier: Apache-2.0
# Renders a lamp above a floor on a Flatlight server:  python3 watch_job.py HOST:PORT
import sys
import uuid

import grpc
from flatlight.v1 import render_service_pb2 as api
from flatlight.v1 import render_service_pb2_grpc, result_pb2
from google.protobuf import json_format

SCENE = {
    "name": "lamp",
    "plane": {
        "materials": [{"name": "white", "lambertian": {"reflectance": [0.8]}}],
        "curves": [
            {"name": "floor", "segment": {"a": {"x": -2, "y": 0}, "b": {"x": 2, "y": 0}}, "material": "white"},
            {"name": "lamp", "segment": {"a": {"x": 0.5, "y": 2}, "b": {"x": -0.5, "y": 2}}, "material": "white",
             "emission": {"radiance": [5]}}]},
    "probes": [{"name": "floor", "curve": "floor", "count": 64}]}

service = render_service_pb2_grpc.RenderServiceStub(grpc.insecure_channel(sys.argv[1]))
request = api.CreateJobRequest(request_id=str(uuid.uuid4()))
json_format.ParseDict({"scene": {"scene": SCENE}, "settings": {"method": "PATH_TRACING", "targetError": 0.01}}, request)
job = service.CreateJob(request)
for update in service.WatchJob(api.WatchJobRequest(name=job.name)):  # Ends with the job.
    if update.HasField("job"):
        print(f"{update.job.progress.fraction:4.0%}, relative error {update.job.progress.relative_error:.2g}")

chunks = service.GetResult(api.GetResultRequest(name=job.name))
result = result_pb2.RenderResult.FromString(b"".join(chunk.data for chunk in chunks))
floor = result.probes[0]
for s, irradiance, error in zip(floor.arc_length, floor.irradiance, floor.standard_error):
    print(f"s = {s:.3f} m   E = {irradiance:.4f} +- {error:.4f} W/m")
