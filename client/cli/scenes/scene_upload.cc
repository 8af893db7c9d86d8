// SPDX-License-Identifier: Apache-2.0
#include "client/cli/scenes/scene_upload.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include "absl/strings/escaping.h"
#include "client/cli/status/exit_code.h"
#include "client/cli/text/numbers.h"
#include "client/cli/text/text_table.h"

namespace flatlight {
namespace {

constexpr std::uint64_t kChunk = 1U << 20;
constexpr std::uint64_t kMessageOverhead = 1U << 10;  // Of an upload's other fields.
constexpr int kMaxRestarts =
    100;  // Others may upload the same scene; each of their chunks can make ours come too late.

absl::StatusOr<std::string> Upload(Connection& connection, const std::string& bytes) {
  const std::uint64_t limit = connection.capabilities().limits().max_message_bytes();
  const std::uint64_t chunk = limit > 2 * kMessageOverhead ? std::min(kChunk, limit - kMessageOverhead) : kChunk;
  v1::UploadSceneRequest request;
  request.set_sha256(Sha256Hex(bytes));
  request.set_total_bytes(bytes.size());
  v1::UploadSceneResponse response;
  int restarts = 0;
  for (;;) {  // The first call, without data, asks how many bytes are there.
    const absl::Status status =
        connection.Call(connection.scenes(), &v1::SceneService::Stub::UploadScene, request, response);
    if (status.code() == absl::StatusCode::kOutOfRange && ++restarts <= kMaxRestarts) {
      request.clear_data();
      request.clear_offset();
      continue;
    }
    if (!status.ok()) return status;
    if (response.received_bytes() >= bytes.size()) return response.name();
    request.set_offset(response.received_bytes());
    request.set_data(bytes.substr(request.offset(), chunk));
  }
}

// "settings.maxBounces: ..." becomes "--max-bounces: ...".
std::string WithOptionNames(const std::string& lines) {
  constexpr std::string_view kPrefix = "settings.";
  std::istringstream in(lines);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(kPrefix)) {
      const std::size_t end = std::min(line.find_first_of(":[", kPrefix.size()), line.size());
      std::string option = "--";
      for (const char c : line.substr(kPrefix.size(), end - kPrefix.size())) {
        if (c == '_' || (c >= 'A' && c <= 'Z')) option += '-';
        if (c != '_') option += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      }
      line = option + line.substr(end);
    }
    out += (out.empty() ? "" : "\n") + line;
  }
  return out;
}

}  // namespace

std::string Sha256Hex(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr);
  return absl::BytesToHexString({reinterpret_cast<const char*>(digest.data()), size});
}

absl::StatusOr<v1::SceneSource> ProvideScene(Connection& connection, const SceneArgument& scene,
                                             const std::vector<v1::Probe>& probes) {
  v1::SceneSource source;
  for (const v1::Probe& probe : probes) *source.add_probes() = probe;
  if (scene.from_server()) {
    source.set_name(scene.name);
    return source;
  }
  const auto bytes = ReadFile(scene.path, scene.label, connection.capabilities().limits().max_scene_bytes(),
                              connection.interruption());
  if (!bytes.ok()) return bytes.status();
  const auto name = Upload(connection, *bytes);
  if (!name.ok()) return name.status();
  source.set_name(*name);
  return source;
}

absl::StatusOr<v1::ValidateSceneResponse> ValidateScene(Connection& connection, const v1::SceneSource& source) {
  v1::ValidateSceneRequest request;
  *request.mutable_scene() = source;
  v1::ValidateSceneResponse response;
  const absl::Status status =
      connection.Call(connection.scenes(), &v1::SceneService::Stub::ValidateScene, request, response);
  if (!status.ok()) return status;
  return response;
}

std::string DiagnosticLines(const SceneArgument& scene, const v1::ValidateSceneResponse& response) {
  std::string lines;
  for (const v1::Diagnostic& diagnostic : response.diagnostics()) {
    if (!lines.empty()) lines += '\n';
    lines += scene.label + ": " + (diagnostic.path().empty() ? "" : Printable(diagnostic.path()) + ": ") +
             Printable(diagnostic.message());
  }
  if (response.more_diagnostics() > 0)
    lines += "\n" + scene.label + ": " + Plural(response.more_diagnostics(), "more mistake");
  return lines;
}

absl::Status ExplainSceneError(Connection& connection, const SceneArgument& scene, const v1::SceneSource& source,
                               const absl::Status& error) {
  if (error.code() == absl::StatusCode::kNotFound)
    return UsageError("there is no scene " + scene.label + "; `flatlight scenes` lists the gallery");
  if (error.code() != absl::StatusCode::kInvalidArgument) return error;
  const auto validation = ValidateScene(connection, source);
  if (validation.ok() && !validation->diagnostics().empty()) return UsageError(DiagnosticLines(scene, *validation));
  return UsageError(WithOptionNames(std::string(error.message().data(), error.message().size())));
}

}  // namespace flatlight
