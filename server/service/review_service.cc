// SPDX-License-Identifier: Apache-2.0
#include "server/service/review_service.h"

#include <utility>

#include "server/service/call.h"
#include "server/service/refused_stream.h"
#include "server/service/stream_caller.h"

namespace flatlight {

template <class Request, class Result>
grpc::ServerUnaryReactor* ReviewService::Call(Context* context, const Bytes* request, Bytes* response,
                                              Result (ReviewCalls::*call)(const Caller&, const Request&)) {
  const auto lane = [](const Request&) { return Lane::kQuick; };
  return Answer<Request>(backend_, context, request, response, lane,
                         [this, call](const Caller& caller, const Request& r) { return (calls_.*call)(caller, r); });
}

grpc::ServerUnaryReactor* ReviewService::CreateRoom(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::Create);
}

grpc::ServerUnaryReactor* ReviewService::GetRoom(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::Get);
}

grpc::ServerUnaryReactor* ReviewService::ListRooms(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::List);
}

grpc::ServerUnaryReactor* ReviewService::ShareRoom(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::Share);
}

grpc::ServerUnaryReactor* ReviewService::UnshareRoom(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::Unshare);
}

grpc::ServerUnaryReactor* ReviewService::LookAt(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::LookAt);
}

grpc::ServerUnaryReactor* ReviewService::AddNote(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::AddNote);
}

grpc::ServerUnaryReactor* ReviewService::CloseRoom(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::Close);
}

grpc::ServerUnaryReactor* ReviewService::DeleteRoom(Context* context, const Bytes* request, Bytes* response) {
  return Call(context, request, response, &ReviewCalls::Delete);
}

grpc::ServerWriteReactor<grpc::ByteBuffer>* ReviewService::WatchRoom(Context* context, const Bytes* request) {
  const auto watch = StartWatch(*context, *request);
  if (!watch.ok()) return new RefusedStream(watch.status());
  return watch->get();
}

absl::StatusOr<std::shared_ptr<RoomWatch>> ReviewService::StartWatch(const Context& context, const Bytes& bytes) {
  const auto caller = AdmitStream(backend_, context, v1::WatchRoomRequest::descriptor()->name());
  if (!caller.ok()) return caller.status();
  v1::WatchRoomRequest request;
  if (absl::Status parsed = FromBytes(bytes, request); !parsed.ok()) return parsed;
  backend_.telemetry.NoteResource(context, request.name());
  const auto room = calls_.FindSeen(*caller, request.name());
  if (!room.ok()) return room.status();
  const bool resumes = request.epoch() == room->epoch && request.after_sequence() > 0;
  const std::uint64_t known = resumes ? request.after_sequence() : 0;
  if (const auto ahead = backend_.rooms.ReadAfter(room->id, known); !ahead.ok()) return ahead.status();
  Watch::Hooks hooks;
  hooks.watcher = caller->name;
  hooks.is_known = [this, caller = *caller] { return backend_.guard.Recheck(caller); };
  hooks.may_see = [this, caller = *caller, name = request.name()] { return calls_.FindSeen(caller, name).status(); };
  auto watch = std::make_shared<RoomWatch>(hub_, backend_.rooms, room->id, room->epoch, known, std::move(hooks));
  const auto most = backend_.guard.QuotasOf(*caller).watches;
  if (absl::Status added = hub_.Add(room->id.Name(), watch, most); !added.ok()) return added;
  if (resumes) ++hub_.counts().resumed;
  return watch;
}

}  // namespace flatlight
